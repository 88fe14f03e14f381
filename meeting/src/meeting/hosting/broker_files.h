// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "meeting/hosting/accounts.h"

namespace telemime::meeting {

/// What Mosquitto is told when it starts.
struct BrokerSettings {
  std::filesystem::path folder;       ///< of its files: absolute, for its user alone
  std::string address = "127.0.0.1";  ///< IPv4, in numbers
  std::uint16_t port = 1883;          ///< of MQTT
  std::uint16_t web_port = 9001;      ///< of MQTT over WebSocket
  std::filesystem::path certificate;  ///< empty: no TLS
  std::filesystem::path key;
  int most_connections = 200;  ///< to each of the two
  std::string user;            ///< whom it runs as when it is started by root
};

/// Its files in that folder. The socket is for this program alone.
std::filesystem::path broker_configuration_file(const std::filesystem::path& folder);
std::filesystem::path broker_password_file(const std::filesystem::path& folder);
std::filesystem::path broker_access_file(const std::filesystem::path& folder);
std::filesystem::path broker_socket(const std::filesystem::path& folder);

/// mosquitto.conf(5). Throws Error(usage) for a path that cannot stand in it (a line break).
std::string broker_configuration(const BrokerSettings& settings);

/// A line of Mosquitto's password file, without its end: PBKDF2 with SHA-512 and a new salt. The passwords
/// are random, so that few rounds do.
std::string password_line(const std::string& user, const std::string& password);

/// Mosquitto's access rules for these accounts; nobody else may do anything.
std::string access_rules(std::span<const BrokerAccount> accounts);

}  // namespace telemime::meeting
