// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/provisioning.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

constexpr std::size_t kMostWaiting = 200;

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Provisioning::Provisioning(MeetingAddress meeting, LoginPolicy policy, BrokerAccount service,
                           const SecretsFile& file, Hooks hooks)
    : meeting_(std::move(meeting)),
      service_(std::move(service)),
      file_(file),
      hooks_(std::move(hooks)),
      policy_(std::move(policy)) {}

Provisioning::~Provisioning() {
  close();
}

void Provisioning::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  changed_.notify_all();
  if (broker_ != nullptr) {
    broker_->give_up();
  }
  if (thread_.joinable()) {
    thread_.join();
  }
  broker_ = nullptr;
}

void Provisioning::open(HostedBroker& broker) {
  broker_ = &broker;
  known_ = members_now();
  thread_ = std::thread([this] { work(); });
}

std::vector<BrokerAccount> Provisioning::accounts() const {
  const std::lock_guard lock(mutex_);
  return accounts_now();
}

std::vector<BrokerAccount> Provisioning::accounts_now() const {
  const std::string& key = policy_.secrets().key;
  std::vector<BrokerAccount> accounts = {service_, watcher_account(meeting_, key)};
  for (const auto& [id, member] : policy_.members()) {
    accounts.push_back(participant_account(meeting_, key, id, member.chair));
  }
  return accounts;
}

std::map<std::string, bool> Provisioning::members_now() const {
  std::map<std::string, bool> members;
  for (const auto& [id, member] : policy_.members()) {
    members.emplace(id, member.chair);
  }
  return members;
}

Provisioning::Grant Provisioning::grant_of(const LoginDecision& decision) const {
  const std::string& key = policy_.secrets().key;
  Grant grant{.result = decision.result,
              .account = {},
              .participant = decision.participant,
              .chair = decision.chair,
              .rejoin = decision.rejoin};
  if (decision.result == LoginResult::accepted) {
    grant.account = decision.participant.empty()
                        ? watcher_account(meeting_, key)
                        : participant_account(meeting_, key, decision.participant, decision.chair);
  }
  return grant;
}

void Provisioning::request(const std::string& body, const std::string& address, Answer answer) {
  const std::optional<LoginRequest> login = read_login_request(body);
  std::optional<Grant> grant;
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() < kMostWaiting) {
      const LoginDecision decision = policy_.log_in(login, address, seconds_now());
      grant = grant_of(decision);
      freed_.insert(freed_.end(), decision.freed.begin(), decision.freed.end());
      // Who is known need not wait for an update, nor share its failure.
      const auto known = known_.find(decision.participant);
      const bool has_account = known != known_.end() && known->second == decision.chair;
      if (!decision.participant.empty() && !has_account) {
        waiting_.push_back({std::move(*grant), std::move(answer)});
        changed_.notify_all();
        return;
      }
    }
  }
  answer(grant);
}

void Provisioning::set_presence(const std::string& participant, bool here) {
  const std::lock_guard lock(mutex_);
  policy_.set_presence(participant, here, seconds_now());
}

void Provisioning::set_all_absent() {
  const std::lock_guard lock(mutex_);
  const std::map<std::string, LoginPolicy::Member> members = policy_.members();
  for (const auto& [id, member] : members) {
    if (member.here) {
      policy_.set_presence(id, false, seconds_now());
    }
  }
}

void Provisioning::lock(bool locked) {
  const std::lock_guard lock(mutex_);
  policy_.lock(locked);
}

void Provisioning::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return closed_ || !waiting_.empty(); });
    if (closed_) {
      return;
    }
    // Take all waiting requests and the accounts that they need.
    std::vector<Waiting> waiting = std::exchange(waiting_, {});
    std::vector<std::string> freed = std::exchange(freed_, {});
    std::erase_if(freed,
                  [this](const std::string& id) { return policy_.members().contains(id); });  // rejoined
    const std::vector<BrokerAccount> accounts = accounts_now();
    const MeetingSecrets secrets = policy_.secrets();
    std::map<std::string, bool> members = members_now();
    std::vector<std::string> chairs;
    for (const auto& [id, chair] : members) {
      if (chair) {
        chairs.push_back(id);
      }
    }
    std::erase_if(known_, [&members](const auto& one) { return !members.contains(one.first); });
    lock.unlock();

    // Update the broker. What it did not take is taken back, but for those who ask again already.
    const bool updated = update_broker(accounts, secrets);
    lock.lock();
    if (updated) {
      known_ = std::move(members);
    } else {
      freed_.insert(freed_.end(), freed.begin(), freed.end());
      for (const Waiting& one : waiting) {
        const std::string& id = one.grant.participant;
        const auto known = known_.find(id);
        if (std::none_of(waiting_.begin(), waiting_.end(),
                         [&id](const Waiting& next) { return next.grant.participant == id; })) {
          policy_.take_back(id, known == known_.end() ? std::nullopt : std::optional(known->second));
        }
      }
    }
    lock.unlock();

    // Answer them.
    if (updated) {
      hooks_.changed(std::move(chairs), freed);
    }
    for (const Waiting& one : waiting) {
      one.answer(updated ? std::optional(one.grant) : std::nullopt);
    }
    lock.lock();
  }
}

// Saves the next number first: if it were lost, another participant would get an account that is in use.
bool Provisioning::update_broker(const std::vector<BrokerAccount>& accounts, const MeetingSecrets& secrets) {
  try {
    file_.save(secrets);
    if (broker_->set_accounts(accounts)) {
      return true;
    }
    hooks_.warn("the broker does not accept new accounts now; newcomers are asked to try again");
  } catch (const Error& e) {
    hooks_.warn(e.what());
  }
  return false;
}

}  // namespace telemime::meeting
