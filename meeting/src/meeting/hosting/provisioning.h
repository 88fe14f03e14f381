// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "meeting/hosting/hosted_broker.h"
#include "meeting/hosting/login_policy.h"
#include "meeting/hosting/secrets.h"

namespace telemime::meeting {

/// Where newcomers get their accounts. Who asks never waits: a thread of the desk has the broker learn the
/// new accounts, of all who ask meanwhile at once, and answers when it has.
class Provisioning {
 public:
  struct Ticket {
    LoginResult answer = LoginResult::malformed;
    BrokerAccount account;    ///< when they may come in
    std::string participant;  ///< empty: only watches
    bool chair = false;
    std::string rejoin;
  };
  /// Nothing: the broker cannot be told now (503).
  using Answer = std::function<void(const std::optional<Ticket>&)>;
  struct Hooks {
    /// From the desk's thread, once the broker knows: who has a chair's rights, and whose accounts are gone.
    std::function<void(std::vector<std::string> chairs, const std::vector<std::string>& freed)> changed;
    std::function<void(const std::string& words)> warn;
  };

  Provisioning(MeetingAddress meeting, MeetingSecrets secrets, LoginRules rules, BrokerAccount service,
               const SecretsFile& file, Hooks hooks);
  Provisioning(const Provisioning&) = delete;
  Provisioning& operator=(const Provisioning&) = delete;
  ~Provisioning();

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
  void set_all_absent();
  void lock(bool locked);

 private:
  struct Waiting {
    Ticket ticket;
    Answer answer;
  };
  void work();
  bool tell_broker(const std::vector<BrokerAccount>& accounts, const MeetingSecrets& secrets);
  std::vector<BrokerAccount> accounts_now() const;
  Ticket ticket_of(const LoginDecision& admission) const;

  const MeetingAddress meeting_;
  const BrokerAccount service_;
  const SecretsFile& file_;
  const Hooks hooks_;
  HostedBroker* broker_ = nullptr;
  mutable std::mutex mutex_;  ///< of what follows
  LoginPolicy door_;
  std::condition_variable changed_;
  std::vector<Waiting> waiting_;
  std::vector<std::string> freed_;
  bool busy_ = false;   ///< the broker is being told
  bool stale_ = false;  ///< it does not know all
  bool end_ = false;
  std::thread thread_;
};

}  // namespace telemime::meeting
