// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/broker_files.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>

#include "meeting/hosting/crypto.h"
#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

constexpr int kRounds = 101;  // like mosquitto_passwd
constexpr std::size_t kSalt = 12;
constexpr std::size_t kHash = 64;

std::string path_text(const std::filesystem::path& path) {
  std::string text = path.string();
  if (std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < ' '; })) {
    throw Error(ErrorKind::usage, "the path \"" + text + "\" cannot be used in the broker's configuration",
                "Choose one without line breaks.");
  }
  return text;
}

// Without socket_domain, WebSockets listen at all addresses, whatever the configuration says
// (Mosquitto 2.0.11).
std::string listener(const BrokerSettings& settings, std::uint16_t port, const std::string& protocol) {
  std::string text = "\nlistener " + std::to_string(port) + " " + settings.address +
                     "\nsocket_domain ipv4\n" + "protocol " + protocol + "\nmax_connections " +
                     std::to_string(settings.most_connections) + "\n";
  if (!settings.certificate.empty()) {
    text += "certfile " + path_text(settings.certificate) + "\nkeyfile " + path_text(settings.key) +
            "\ntls_version tlsv1.2\n";
  }
  return text;
}

}  // namespace

std::filesystem::path broker_configuration_file(const std::filesystem::path& folder) {
  return folder / "mosquitto.conf";
}
std::filesystem::path broker_password_file(const std::filesystem::path& folder) {
  return folder / "passwords";
}
std::filesystem::path broker_access_file(const std::filesystem::path& folder) {
  return folder / "access";
}
std::filesystem::path broker_socket(const std::filesystem::path& folder) {
  return folder / "socket";
}

std::string broker_configuration(const BrokerSettings& settings) {
  const auto& folder = settings.folder;
  return "per_listener_settings false\n"
         "allow_anonymous false\n"
         "password_file " +
         path_text(broker_password_file(folder)) + "\nacl_file " + path_text(broker_access_file(folder)) +
         "\n" + (settings.user.empty() ? "" : "user " + settings.user + "\n") +
         "persistence false\n"
         "log_dest stderr\n"
         "log_type error\n"
         "log_type warning\n"
         "sys_interval 0\n"
         "max_packet_size 65536\n"
         "max_inflight_messages 20\n"
         "max_queued_messages 500\n"
         "max_queued_bytes 4194304\n"
         "memory_limit 268435456\n"
         "persistent_client_expiration 1h\n"
         "set_tcp_nodelay true\n"
         "\nlistener 0 " +
         path_text(broker_socket(folder)) + "\nprotocol mqtt\n" + listener(settings, settings.port, "mqtt") +
         listener(settings, settings.web_port, "websockets");
}

std::string password_line(const std::string& user, const std::string& password) {
  const std::string salt = random_bytes(kSalt);
  std::array<unsigned char, kHash> hash{};
  if (::PKCS5_PBKDF2_HMAC(password.data(), static_cast<int>(password.size()),
                          reinterpret_cast<const unsigned char*>(salt.data()), static_cast<int>(salt.size()),
                          kRounds, ::EVP_sha512(), static_cast<int>(hash.size()), hash.data()) != 1) {
    throw Error(ErrorKind::output, "passwords cannot be hashed on this computer");
  }
  return user + ":$7$" + std::to_string(kRounds) + "$" + base64(salt) + "$" +
         base64({reinterpret_cast<const char*>(hash.data()), hash.size()});
}

std::string access_rules(std::span<const BrokerAccount> accounts) {
  std::string text;
  for (const BrokerAccount& account : accounts) {
    text += "user " + account.user + "\n";
    for (const std::string& topic : account.read) {
      text += "topic read " + topic + "\n";
    }
    for (const std::string& topic : account.write) {
      text += "topic write " + topic + "\n";
    }
    text += "\n";
  }
  return text;
}

}  // namespace telemime::meeting
