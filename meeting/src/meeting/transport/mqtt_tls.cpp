// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/mqtt_tls.h"

#include <openssl/ssl.h>
#include <openssl/x509_vfy.h>
#include <openssl/x509v3.h>

#include <boost/asio/ip/address.hpp>

#include "meeting/transport/tls_authorities.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

MqttTls& owner_of(const SSL* connection) {
  return *static_cast<MqttTls*>(SSL_CTX_get_ex_data(SSL_get_SSL_CTX(connection), 0));
}

}  // namespace

std::string tls_refusal(long result, const std::string& host) {
  switch (result) {
    case X509_V_ERR_HOSTNAME_MISMATCH:
    case X509_V_ERR_IP_ADDRESS_MISMATCH:
      return "its certificate is not one for \"" + host + "\"";
    case X509_V_ERR_DEPTH_ZERO_SELF_SIGNED_CERT:
    case X509_V_ERR_SELF_SIGNED_CERT_IN_CHAIN:
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT:
    case X509_V_ERR_UNABLE_TO_GET_ISSUER_CERT_LOCALLY:
    case X509_V_ERR_UNABLE_TO_VERIFY_LEAF_SIGNATURE:
    case X509_V_ERR_CERT_SIGNATURE_FAILURE:
      return "its certificate was signed by nobody who is trusted here (ca=FILE names the one who is)";
    case X509_V_ERR_CERT_HAS_EXPIRED:
    case X509_V_ERR_CERT_NOT_YET_VALID:
      return "its certificate is not valid today";
    default:
      return std::string("its certificate is not accepted: ") + X509_verify_cert_error_string(result);
  }
}

void MqttTls::Free::operator()(SSL_CTX* context) const {
  SSL_CTX_free(context);
}

MqttTls::MqttTls(const std::string& host, const std::string& ca_file)
    : host_(host), context_(SSL_CTX_new(TLS_client_method())) {
  boost::system::error_code no_address;
  boost::asio::ip::make_address(host, no_address);
  is_address_ = !no_address;
  SSL_CTX* const context = context_.get();
  if (context == nullptr || SSL_CTX_set_ex_data(context, 0, this) != 1 ||
      SSL_CTX_set_min_proto_version(context, TLS1_2_VERSION) != 1) {
    throw Error(ErrorKind::usage, "TLS cannot be used on this computer");
  }
  X509_VERIFY_PARAM* const asked = SSL_CTX_get0_param(context);
  X509_VERIFY_PARAM_set_hostflags(asked, X509_CHECK_FLAG_NO_PARTIAL_WILDCARDS);
  if ((is_address_ ? X509_VERIFY_PARAM_set1_ip_asc(asked, host.c_str())
                   : X509_VERIFY_PARAM_set1_host(asked, host.c_str(), host.size())) != 1) {
    throw Error(ErrorKind::usage, "\"" + host + "\" cannot stand in a certificate",
                "Give the broker's name or address.");
  }
  trust_authorities(context, ca_file);
  SSL_CTX_set_verify(context, SSL_VERIFY_PEER, verify);
  SSL_CTX_set_info_callback(context, on_progress);
}

MqttTls::~MqttTls() = default;

void MqttTls::forget() {
  refusal_.clear();
  shaken_ = false;
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
  if ((where & SSL_CB_HANDSHAKE_START) != 0 && !own.shaken_) {
    // libmosquitto was given an address; the server is to be told the name, as it may have several.
    const char* const name = own.is_address_ ? nullptr : own.host_.c_str();
    SSL_set_tlsext_host_name(const_cast<SSL*>(connection), name);
  }
  own.shaken_ = own.shaken_ || (where & SSL_CB_HANDSHAKE_DONE) != 0;
}

}  // namespace telemime::meeting
