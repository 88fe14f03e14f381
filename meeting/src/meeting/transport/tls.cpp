// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/tls.h"

#include <openssl/bio.h>
#include <openssl/err.h>
#include <openssl/pem.h>
#include <openssl/ssl.h>
#include <openssl/x509_vfy.h>
#include <openssl/x509v3.h>

#include <boost/asio/ip/address.hpp>
#include <stdexcept>

#include "telemime/core/errors.h"
#include "telemime/core/files.h"

namespace telemime::meeting {
namespace {

constexpr std::size_t kLongestFile = 4U << 20;  // bytes; the system's own has 0.2 MB

/// Adds all certificates. Returns their number; 0 when one of them is invalid.
int add_all(X509_STORE* store, const std::string& pem) {
  const std::unique_ptr<BIO, int (*)(BIO*)> text(BIO_new_mem_buf(pem.data(), static_cast<int>(pem.size())),
                                                 BIO_free);
  int added = 0;
  while (text) {
    // Also reads "TRUSTED CERTIFICATE", as OpenSSL does for files.
    const std::unique_ptr<X509, void (*)(X509*)> certificate(
        PEM_read_bio_X509_AUX(text.get(), nullptr, nullptr, nullptr), X509_free);
    if (!certificate) {
      return ERR_GET_REASON(ERR_peek_last_error()) == PEM_R_NO_START_LINE ? added : 0;
    }
    added += X509_STORE_add_cert(store, certificate.get());
  }
  return added;
}

MqttTls& owner_of(const SSL* connection) {
  return *static_cast<MqttTls*>(SSL_CTX_get_ex_data(SSL_get_SSL_CTX(connection), 0));
}

}  // namespace

std::string tls_refusal(long result, const std::string& host) {
  switch (result) {
    case X509_V_ERR_HOSTNAME_MISMATCH:
    case X509_V_ERR_IP_ADDRESS_MISMATCH:
      return "its certificate is not valid for \"" + host + "\"";
    case X509_V_ERR_DEPTH_ZERO_SELF_SIGNED_CERT:
    case X509_V_ERR_SELF_SIGNED_CERT_IN_CHAIN:
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT:
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT_LOCALLY:
    case X509_V_ERR_UNABLE_TO_VERIFY_LEAF_SIGNATURE:
    case X509_V_ERR_CERT_SIGNATURE_FAILURE:
      return "its certificate is not signed by a trusted authority (ca=FILE names one)";
    case X509_V_ERR_CERT_HAS_EXPIRED:
    case X509_V_ERR_CERT_NOT_YET_VALID:
      return "its certificate has expired or is not valid yet";
    default:
      return std::string("its certificate is not accepted: ") + X509_verify_cert_error_string(result);
  }
}

void trust_authorities(SSL_CTX* context, const std::filesystem::path& ca) {
  std::string reason;
  if (ca.empty()) {
    SSL_CTX_set_default_verify_paths(context);
  } else {
    try {
      if (add_all(SSL_CTX_get_cert_store(context), read_small_file(ca, kLongestFile).content) == 0) {
        reason = "it contains none, or an invalid one";
      }
    } catch (const std::runtime_error& e) {
      reason = e.what();
    }
  }
  ERR_clear_error();
  if (!reason.empty()) {
    throw Error(ErrorKind::usage, "no certificates can be read from " + ca.string() + ": " + reason,
                "ca=FILE names a file of certificates in PEM form.");
  }
}

MqttTls::MqttTls(const std::string& host, const std::string& ca)
    : host_(host), context_(SSL_CTX_new(TLS_client_method()), SSL_CTX_free) {
  boost::system::error_code no_address;
  boost::asio::ip::make_address(host, no_address);
  is_address_ = !no_address;
  SSL_CTX* const context = context_.get();
  if (context == nullptr || SSL_CTX_set_ex_data(context, 0, this) != 1 ||
      SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION) != 1) {
    throw Error(ErrorKind::usage, "TLS cannot be used on this computer");
  }
  X509_VERIFY_PARAM* const expected = SSL_CTX_get0_param(context);
  X509_VERIFY_PARAM_set_hostflags(expected, X509_CHECK_FLAG_NO_PARTIAL_WILDCARDS);
  if ((is_address_ ? X509_VERIFY_PARAM_set1_ip_asc(expected, host.c_str())
                   : X509_VERIFY_PARAM_set1_host(expected, host.c_str(), host.size())) != 1) {
    throw Error(ErrorKind::usage, "\"" + host + "\" cannot be the host of a certificate",
                "Give the broker's name or address.");
  }
  trust_authorities(context, ca);
  SSL_CTX_set_verify(context, SSL_VERIFY_PEER, verify);
  SSL_CTX_set_info_callback(context, on_progress);
}

void MqttTls::reset() {
  refusal_.clear();
  established_ = false;
}

int MqttTls::verify(int accepted, X509_STORE_CTX* store) {
  if (accepted == 0) {
    const auto* const connection =
        static_cast<const SSL*>(X509_STORE_CTX_get_ex_data(store, SSL_get_ex_data_X509_STORE_CTX_idx()));
    MqttTls& own = owner_of(connection);
    own.refusal_ = tls_refusal(X509_STORE_CTX_get_error(store), own.host_);
  }
  return accepted;
}

void MqttTls::on_progress(const SSL* connection, int where, int /*value*/) {
  MqttTls& own = owner_of(connection);
  if ((where & SSL_CB_HANDSHAKE_START) != 0 && !own.established_) {
    // libmosquitto connects to an address; the server must learn the name, because it may have several.
    const char* const name = own.is_address_ ? nullptr : own.host_.c_str();
    SSL_set_tlsext_host_name(const_cast<SSL*>(connection), name);
  }
  own.established_ = own.established_ || (where & SSL_CB_HANDSHAKE_DONE) != 0;
}

}  // namespace telemime::meeting
