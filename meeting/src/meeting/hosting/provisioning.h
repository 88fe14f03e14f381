// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "meeting/hosting/hosted_broker.h"
#include "meeting/hosting/login_policy.h"

namespace telemime::meeting {

/// Gives accounts to those who log in. request() never blocks: a thread updates the broker, for all waiting
/// requests at once, and answers them when the broker knows their accounts.
class Provisioning {
 public:
  struct Grant {
    LoginResult result = LoginResult::malformed;
    BrokerAccount account;    ///< if accepted
    std::string participant;  ///< empty: only watches
    bool chair = false;
    std::string rejoin;
  };
  /// Nothing: the broker cannot be updated now (503).
  using Answer = std::function<void(const std::optional<Grant>&)>;
  struct Hooks {
    /// From the thread, after an update of the broker: the chairs, and participants whose accounts were
    /// removed.
    std::function<void(std::vector<std::string> chairs, const std::vector<std::string>& freed)> changed;
    std::function<void(const std::string& text)> warn;
  };

  Provisioning(MeetingAddress meeting, LoginPolicy policy, BrokerAccount service, const SecretsFile& file,
               Hooks hooks);
  Provisioning(const Provisioning&) = delete;
  Provisioning& operator=(const Provisioning&) = delete;
  ~Provisioning();

  /// All current accounts, for the start of the broker.
  std::vector<BrokerAccount> accounts() const;
  /// From now on the broker is updated.
  void open(HostedBroker& broker);
  /// Stops the updates; waiting requests are never answered. A second call does nothing.
  void close();

  /// From any thread. `answer` is called once, from this call or from the thread.
  void request(const std::string& body, const std::string& address, Answer answer);
  /// From any thread.
  void set_presence(const std::string& participant, bool here);
  void set_all_absent();
  void lock(bool locked);

 private:
  struct Waiting {
    Grant grant;
    Answer answer;
  };
  void work();
  bool update_broker(const std::vector<BrokerAccount>& accounts, const MeetingSecrets& secrets);
  std::vector<BrokerAccount> accounts_now() const;
  Grant grant_of(const LoginDecision& decision) const;
  std::map<std::string, bool> members_now() const;

  const MeetingAddress meeting_;
  const BrokerAccount service_;
  const SecretsFile& file_;
  const Hooks hooks_;
  HostedBroker* broker_ = nullptr;
  mutable std::mutex mutex_;  ///< of what follows
  LoginPolicy policy_;
  std::condition_variable changed_;
  std::vector<Waiting> waiting_;
  std::vector<std::string> freed_;
  /// Participants whose accounts the broker has, whatever becomes of an update; true: with a chair's rights.
  std::map<std::string, bool> known_;
  bool closed_ = false;
  std::thread thread_;
};

}  // namespace telemime::meeting
