// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "meeting/hosting/accounts.h"
#include "meeting/hosting/broker_files.h"
#include "meeting/hosting/broker_process.h"
#include "telemime/core/scratch_folder.h"

namespace telemime::meeting {

/// Where the broker of a meeting listens.
struct BrokerOptions {
  std::string program;                    ///< path of Mosquitto; empty: the installed one
  std::string address = "127.0.0.1";      ///< numeric IPv4
  std::optional<std::uint16_t> port;      ///< of MQTT; nothing: the usual one, or a free one
  std::optional<std::uint16_t> web_port;  ///< of MQTT over WebSocket, likewise
  std::uint16_t page_port = 0;            ///< of the meeting's page, which the broker must leave free; 0: any
  std::filesystem::path certificate;      ///< empty: no TLS
  std::filesystem::path key;
  int most_connections = 200;
};

/// A Mosquitto that this program runs, with the given accounts only.
class HostedBroker {
 public:
  using Report = std::function<void(const std::string& text)>;

  /// Returns when the broker accepts clients. Throws Error(usage) when there is no Mosquitto or a file cannot
  /// be read, and Error(output) when a requested port is taken or the broker does not start.
  HostedBroker(BrokerOptions options, const MeetingAddress& meeting, std::vector<BrokerAccount> accounts,
               Report report);

  std::uint16_t port() const { return settings_.port; }
  std::uint16_t web_port() const { return settings_.web_port; }
  std::filesystem::path socket() const { return broker_socket(folder_.path()); }
  pid_t process() const { return process_->process(); }

  /// Replaces the accounts; connections of removed ones end. Returns true when the broker has applied them,
  /// and false after 10 s (if it is restarting, it will apply them later). Throws Error(output) when the
  /// files cannot be written. For one thread at a time.
  bool set_accounts(std::vector<BrokerAccount> accounts);
  /// From any thread: set_accounts() does not wait any more.
  void give_up() { given_up_ = true; }

 private:
  void write_accounts();
  bool start(const std::filesystem::path& program);
  bool comes_up() const;
  std::string failure() const;
  bool knows_accounts() const;

  const ScratchFolder folder_;
  const std::string meeting_;
  BrokerSettings settings_;
  Report report_;
  std::vector<BrokerAccount> accounts_;
  BrokerAccount probe_;  ///< in no earlier set of accounts: the broker knows all when it knows this one
  unsigned generation_ = 0;
  std::atomic<bool> given_up_ = false;
  std::unique_ptr<BrokerProcess> process_;
};

}  // namespace telemime::meeting
