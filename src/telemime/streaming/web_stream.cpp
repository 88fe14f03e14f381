// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_stream.h"

#include <openssl/err.h>
#include <openssl/ssl.h>

#include <cerrno>
#include <fstream>
#include <string>
#include <system_error>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

namespace ip = boost::asio::ip;
namespace ssl = boost::asio::ssl;

void require_readable(const std::filesystem::path& file, const std::string& what) {
  errno = 0;
  std::ifstream in(file);
  if (!in || in.peek() == std::ifstream::traits_type::eof()) {
    const int number = errno;
    throw Error(ErrorKind::usage, "the " + what + " cannot be read: " + file.string() + ": " +
                                      (number == 0 ? std::string("the file is empty")
                                                   : std::generic_category().message(number)));
  }
}

// Called for a key with a password, which nobody can type here.
int no_password(char* /*buffer*/, int /*size*/, int /*writes*/, void* /*data*/) {
  return 0;
}

ip::address plain(const ip::address& address) {
  return address.is_v6() && address.to_v6().is_v4_mapped()
             ? ip::address(ip::make_address_v4(ip::v4_mapped, address.to_v6()))
             : address;
}

}  // namespace

ip::address local_address(const ip::tcp::socket& socket) {
  boost::system::error_code closed;
  return plain(socket.local_endpoint(closed).address());
}

ip::address remote_address(const ip::tcp::socket& socket) {
  boost::system::error_code closed;
  return plain(socket.remote_endpoint(closed).address());
}

std::shared_ptr<ssl::context> web_tls(const std::filesystem::path& certificate,
                                      const std::filesystem::path& key) {
  require_readable(certificate, "certificate");
  require_readable(key, "certificate's key");
  auto tls = std::make_shared<ssl::context>(ssl::context::tls_server);
  SSL_CTX* const native = tls->native_handle();
  SSL_CTX_set_min_proto_version(native, TLS1_2_VERSION);
  SSL_CTX_set_default_passwd_cb(native, no_password);
  ERR_clear_error();
  if (SSL_CTX_use_certificate_chain_file(native, certificate.c_str()) != 1) {
    ERR_clear_error();
    throw Error(ErrorKind::usage, "there is no usable certificate in " + certificate.string(),
                "Use a PEM file: the server's certificate first, then the intermediate ones.");
  }
  if (SSL_CTX_use_PrivateKey_file(native, key.c_str(), SSL_FILETYPE_PEM) != 1) {
    const bool another = ERR_GET_LIB(ERR_peek_error()) == ERR_LIB_X509;
    ERR_clear_error();
    if (another) {
      throw Error(ErrorKind::usage, key.string() + " is not the key of " + certificate.string());
    }
    throw Error(ErrorKind::usage, "there is no usable key in " + key.string(),
                "Use a PEM file without a password.");
  }
  return tls;
}

}  // namespace telemime
