// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openssl/types.h>

#include <memory>
#include <string>

namespace telemime::meeting {

/// Why a certificate was refused, in words: the result of OpenSSL's verification for that host.
std::string tls_refusal(long result, const std::string& host);

/// How a client connects by TLS (1.2 or newer) to one host: whose certificates it trusts, and that the host's
/// name or address stands in its certificate. Serves any number of connections, one after the other.
class MqttTls {
 public:
  /// `ca_file`: certificates (PEM) that are trusted, empty for the system's. Throws Error(usage) when it
  /// cannot be read or the host is no name.
  MqttTls(const std::string& host, const std::string& ca_file);
  MqttTls(const MqttTls&) = delete;
  MqttTls& operator=(const MqttTls&) = delete;
  ~MqttTls();

  SSL_CTX* context() const { return context_.get(); }
  /// A new connection begins.
  void forget();
  /// Why the host's certificate was refused, in words; empty when it was not.
  const std::string& refusal() const { return refusal_; }
  /// Whether the handshake has come to its end.
  bool shaken() const { return shaken_; }

 private:
  struct Free {
    void operator()(SSL_CTX* context) const;
  };
  static int verify(int accepted, X509_STORE_CTX* store);
  static void on_progress(const SSL* connection, int where, int value);

  std::string host_;
  bool is_address_ = false;
  std::string refusal_;
  bool shaken_ = false;
  std::unique_ptr<SSL_CTX, Free> context_;
};

}  // namespace telemime::meeting
