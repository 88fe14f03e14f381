// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <openssl/types.h>

#include <filesystem>
#include <memory>
#include <string>

namespace telemime::meeting {

inline constexpr const char* kNoTls = "the TLS handshake failed; does that port use TLS?";

/// Why a certificate was rejected, from the result of OpenSSL's verification for that host.
std::string tls_refusal(long result, const std::string& host);

/// Trusts the certificates (PEM) in the file `ca`, of at most 4 MB; empty: those of the system. Throws
/// Error(usage) when the file has none, or an invalid one.
void trust_authorities(SSL_CTX* context, const std::filesystem::path& ca);

/// The TLS (1.2 or newer) client settings for one host, whose name or address must be in its certificate.
/// Serves any number of connections, one after the other.
class MqttTls {
 public:
  /// `ca` as for trust_authorities(). Throws Error(usage) when it cannot be used or the host is invalid.
  MqttTls(const std::string& host, const std::string& ca);
  MqttTls(const MqttTls&) = delete;
  MqttTls& operator=(const MqttTls&) = delete;

  SSL_CTX* context() const { return context_.get(); }
  /// Prepares for a new connection.
  void reset();
  /// Why the host's certificate was rejected; empty when it was not.
  const std::string& refusal() const { return refusal_; }
  /// Whether the handshake is complete.
  bool established() const { return established_; }

 private:
  static int verify(int accepted, X509_STORE_CTX* store);
  static void on_progress(const SSL* connection, int where, int value);

  std::string host_;
  bool is_address_ = false;
  std::string refusal_;
  bool established_ = false;
  std::unique_ptr<SSL_CTX, void (*)(SSL_CTX*)> context_;
};

}  // namespace telemime::meeting
