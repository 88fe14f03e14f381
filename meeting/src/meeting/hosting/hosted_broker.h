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

/// Where the room's broker shall listen.
struct BrokerPlace {
  std::string program;                    ///< Mosquitto's; empty: the installed one
  std::string address = "127.0.0.1";      ///< IPv4, in numbers
  std::optional<std::uint16_t> port;      ///< of MQTT; nothing: the usual one, or another that is free
  std::optional<std::uint16_t> web_port;  ///< of MQTT over WebSocket; the same
  std::filesystem::path certificate;      ///< empty: no TLS
  std::filesystem::path key;
  int most_connections = 200;
};

/// A Mosquitto of this program's own, with the accounts that it is given and nobody else.
class HostedBroker {
 public:
  using Tell = std::function<void(const std::string& words)>;

  /// Returns when it works. Throws Error(usage) when there is no Mosquitto or it refuses what it was told,
  /// Error(output) when a port that was asked for is taken or it does not start.
  HostedBroker(BrokerPlace place, const MeetingAddress& meeting, std::vector<BrokerAccount> accounts,
               Tell tell);

  std::uint16_t port() const { return settings_.port; }
  std::uint16_t web_port() const { return settings_.web_port; }
  std::filesystem::path socket() const { return broker_socket(folder_.path()); }
  pid_t process() const { return process_->process(); }

  /// Has the broker know these accounts and no others; connections of the others end. Returns when it does:
  /// true; false when it has not after 10 s (it may be starting anew, and then it will). Throws Error(output)
  /// when the files cannot be written. For one thread at a time.
  bool set_accounts(std::vector<BrokerAccount> accounts);
  /// From any thread: set_accounts() waits no longer, now and later.
  void give_up() { given_up_ = true; }

 private:
  void write_accounts();
  bool start(const std::filesystem::path& program);
  bool comes_up() const;
  std::string why_not() const;
  bool knows_newest() const;

  const ScratchFolder folder_;
  const std::string meeting_;
  BrokerSettings settings_;
  Tell tell_;
  std::vector<BrokerAccount> accounts_;
  BrokerAccount newest_;  ///< nobody's: the broker knows it when it knows all
  unsigned generation_ = 0;
  std::atomic<bool> given_up_ = false;
  std::unique_ptr<BrokerProcess> process_;
};

}  // namespace telemime::meeting
