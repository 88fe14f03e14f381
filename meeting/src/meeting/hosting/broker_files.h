// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "meeting/hosting/accounts.h"

namespace telemime::meeting {

/// The configuration of Mosquitto.
struct BrokerSettings {
  std::filesystem::path folder;       ///< of its files: absolute, accessible to its user only
  std::string address = "127.0.0.1";  ///< numeric IPv4
  std::uint16_t port = 1883;          ///< of MQTT
  std::uint16_t web_port = 9001;      ///< of MQTT over WebSocket
  std::filesystem::path certificate;  ///< empty: no TLS
  std::filesystem::path key;
  int most_connections = 200;  ///< to each of the two ports
  std::string user;            ///< to run as when root starts it
};

/// Its files in that folder. The socket is for this program only.
std::filesystem::path broker_configuration_file(const std::filesystem::path& folder);
std::filesystem::path broker_password_file(const std::filesystem::path& folder);
std::filesystem::path broker_access_file(const std::filesystem::path& folder);
std::filesystem::path broker_socket(const std::filesystem::path& folder);

/// The text of mosquitto.conf(5). Throws Error(usage) for a path with a line break.
std::string broker_configuration(const BrokerSettings& settings);

/// A line of Mosquitto's password file: PBKDF2 with SHA-512 and a new salt. Few rounds suffice because the
/// passwords are random.
std::string password_line(const std::string& user, const std::string& password);

/// Mosquitto's access rules for these accounts. All others are forbidden everything.
std::string access_rules(std::span<const BrokerAccount> accounts);

}  // namespace telemime::meeting
