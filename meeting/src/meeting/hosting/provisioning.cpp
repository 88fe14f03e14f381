// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/provisioning.h"

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

Provisioning::Provisioning(MeetingAddress meeting, MeetingSecrets secrets, LoginRules rules,
                           BrokerAccount service, const SecretsFile& file, Hooks hooks)
    : meeting_(std::move(meeting)),
      service_(std::move(service)),
      file_(file),
      hooks_(std::move(hooks)),
      door_(std::move(secrets), rules) {}

Provisioning::~Provisioning() {
  close();
}

void Provisioning::close() {
  {
    const std::lock_guard lock(mutex_);
    end_ = true;
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
  thread_ = std::thread([this] { work(); });
}

std::vector<BrokerAccount> Provisioning::accounts() const {
  const std::lock_guard lock(mutex_);
  return accounts_now();
}

std::vector<BrokerAccount> Provisioning::accounts_now() const {
  const std::string& key = door_.secrets().key;
  std::vector<BrokerAccount> accounts = {service_, watcher_account(meeting_, key)};
  for (const auto& [id, member] : door_.members()) {
    accounts.push_back(participant_account(meeting_, key, id, member.chair));
  }
  return accounts;
}

Provisioning::Ticket Provisioning::ticket_of(const LoginDecision& admission) const {
  const std::string& key = door_.secrets().key;
  Ticket ticket{admission.answer, {}, admission.participant, admission.chair, admission.rejoin};
  if (admission.answer == LoginResult::log_in) {
    ticket.account = admission.participant.empty()
                         ? watcher_account(meeting_, key)
                         : participant_account(meeting_, key, admission.participant, admission.chair);
  }
  return ticket;
}

void Provisioning::ask(const std::string& body, const std::string& address, Answer answer) {
  const std::optional<LoginRequest> question = read_login_request(body);
  std::optional<Ticket> ticket;
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() < kMostWaiting) {
      const LoginDecision admission = door_.enter(question, address, seconds_now());
      ticket = ticket_of(admission);
      freed_.insert(freed_.end(), admission.freed.begin(), admission.freed.end());
      stale_ = stale_ || admission.changed;
      // Who comes back while the broker is being told may be one of those whom it does not know yet.
      if (!admission.participant.empty() && (stale_ || busy_)) {
        waiting_.push_back({std::move(*ticket), std::move(answer)});
        changed_.notify_all();
        return;
      }
    }
  }
  answer(ticket);
}

void Provisioning::seen(const std::string& participant, bool here) {
  const std::lock_guard lock(mutex_);
  door_.seen(participant, here, seconds_now());
}

void Provisioning::set_all_absent() {
  const std::lock_guard lock(mutex_);
  const std::map<std::string, LoginPolicy::Member> members = door_.members();
  for (const auto& [id, member] : members) {
    if (member.here) {
      door_.seen(id, false, seconds_now());
    }
  }
}

void Provisioning::lock(bool locked) {
  const std::lock_guard lock(mutex_);
  door_.lock(locked);
}

void Provisioning::work() {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return end_ || !waiting_.empty(); });
    if (end_) {
      return;
    }
    std::vector<Waiting> waiting = std::exchange(waiting_, {});
    std::vector<std::string> freed = std::exchange(freed_, {});
    std::erase_if(freed, [this](const std::string& id) { return door_.members().contains(id); });  // is back
    const std::vector<BrokerAccount> accounts = accounts_now();
    const MeetingSecrets secrets = door_.secrets();
    std::vector<std::string> chairs;
    for (const auto& [id, member] : door_.members()) {
      if (member.chair) {
        chairs.push_back(id);
      }
    }
    busy_ = true;
    stale_ = false;
    lock.unlock();
    const bool known = tell_broker(accounts, secrets);
    if (known) {
      hooks_.changed(std::move(chairs), freed);
    }
    for (const Waiting& one : waiting) {
      one.answer(known ? std::optional(one.ticket) : std::nullopt);
    }
    lock.lock();
    busy_ = false;
    stale_ = stale_ || !known;
    if (!known) {
      freed_.insert(freed_.end(), freed.begin(), freed.end());
    }
  }
}

// The next number first: were it lost, somebody else would get an account that was given out.
bool Provisioning::tell_broker(const std::vector<BrokerAccount>& accounts, const MeetingSecrets& secrets) {
  try {
    file_.save(secrets);
    if (broker_->set_accounts(accounts)) {
      return true;
    }
    hooks_.warn("the broker does not take new accounts now; newcomers are asked to try again");
  } catch (const Error& e) {
    hooks_.warn(e.what());
  }
  return false;
}

}  // namespace telemime::meeting
