// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "meeting/hosting/door.h"
#include "meeting/hosting/hosted_broker.h"
#include "meeting/hosting/room_secrets.h"

namespace telemime {

/// Where newcomers get their accounts. Who asks never waits: a thread of the desk has the broker learn the
/// new accounts, of all who ask meanwhile at once, and answers when it has.
class EntryDesk {
 public:
  struct Ticket {
    DoorAnswer answer = DoorAnswer::malformed;
    BrokerAccount account;    ///< when they may come in
    std::string participant;  ///< empty: only watches
    bool chair = false;
    std::string way_back;
  };
  /// Nothing: the broker cannot be told now (503).
  using Answer = std::function<void(const std::optional<Ticket>&)>;
  struct Hooks {
    /// From the desk's thread, once the broker knows: who has a chair's rights, and whose accounts are gone.
    std::function<void(std::vector<std::string> chairs, const std::vector<std::string>& freed)> changed;
    std::function<void(const std::string& words)> warn;
  };

  EntryDesk(RoomAddress room, RoomSecrets secrets, DoorRules rules, BrokerAccount service,
            const SecretsFile& file, Hooks hooks);
  EntryDesk(const EntryDesk&) = delete;
  EntryDesk& operator=(const EntryDesk&) = delete;
  ~EntryDesk();

  /// The accounts that there are: for the broker's start.
  std::vector<BrokerAccount> accounts() const;
  /// From now on the broker is told.
  void open(HostedBroker& broker);
  /// From now on it is not: who waits is never answered. The second time it does nothing.
  void close();

  /// From any thread. `answer` is called once, at once or from the desk's thread.
  void ask(const std::string& body, const std::string& address, Answer answer);
  /// From any thread.
  void seen(const std::string& participant, bool here);
  void nobody_is_here();
  void lock(bool locked);

 private:
  struct Waiting {
    Ticket ticket;
    Answer answer;
  };
  void work();
  bool tell_broker(const std::vector<BrokerAccount>& accounts, const RoomSecrets& secrets);
  std::vector<BrokerAccount> accounts_now() const;
  Ticket ticket_of(const Admission& admission) const;

  const RoomAddress room_;
  const BrokerAccount service_;
  const SecretsFile& file_;
  const Hooks hooks_;
  HostedBroker* broker_ = nullptr;
  mutable std::mutex mutex_;  ///< of what follows
  Door door_;
  std::condition_variable changed_;
  std::vector<Waiting> waiting_;
  std::vector<std::string> freed_;
  bool busy_ = false;   ///< the broker is being told
  bool stale_ = false;  ///< it does not know all
  bool end_ = false;
  std::thread thread_;
};

}  // namespace telemime
