// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "meeting/hosting/accounts.h"
#include "meeting/hosting/secrets.h"

namespace telemime::meeting {

/// How often one network address may try to log in.
struct RateLimitOptions {
  double attempts = 120.0;           ///< at once
  double attempts_per_second = 2.0;  ///< that are added again
  double failures = 20.0;            ///< with a wrong link, at once
  double failures_per_second = 0.33;
  std::size_t most_addresses = 4096;  ///< to remember
};

/// Limits the logins per address. For IPv6 only the first 64 bits count, because one computer has all of the
/// rest. Times are s and must not decrease.
class RateLimit {
 public:
  explicit RateLimit(const RateLimitOptions& options = {}) : options_(options) {}
  /// Counts an attempt with a valid link. Returns whether it is within the limit.
  bool allow(const std::string& address, double now) { return take(of(address, now).attempts); }
  /// The same for an attempt with a wrong link. It has a limit of its own, so that guessing does not lock out
  /// others at the same address: the secrets are too long to guess.
  bool allow_failure(const std::string& address, double now) { return take(of(address, now).failures); }

 private:
  struct Left {
    double attempts;
    double failures;
    double at;
  };
  Left& of(const std::string& address, double now);
  static bool take(double& left);

  RateLimitOptions options_;
  std::unordered_map<std::string, Left> left_;
};

/// The body of POST /room/enter (meeting/docs/protocol.md, "Login").
struct LoginRequest {
  std::optional<std::string> invite;
  std::optional<std::string> rejoin;
  bool watch = false;
};

/// Returns nothing when the bytes are not a valid request. Unknown members are ignored. Never throws.
std::optional<LoginRequest> read_login_request(std::string_view body);

/// The HTTP status of the answer.
enum class LoginResult {
  accepted = 200,
  malformed = 400,
  wrong_link = 403,
  full = 409,
  locked = 423,
  too_many_attempts = 429,
};

struct LoginDecision {
  LoginResult result = LoginResult::malformed;
  std::string participant;  ///< empty: only watches
  bool chair = false;
  std::string rejoin;              ///< the participant's token
  std::vector<std::string> freed;  ///< participants whose accounts were removed
};

struct LoginRules {
  std::size_t most = 40;       ///< accounts of participants at once
  double keeps_seat = 300.0;   ///< s that an absent participant keeps the account while others need one
  double joins_within = 30.0;  ///< s that a new participant who never joined keeps it; at most keeps_seat
  RateLimitOptions rate_limit;
};

/// Decides who can join a meeting, and as which participant. Each newcomer is a new participant; someone who
/// rejoins is the same one. When there are no more accounts, those who never joined lose theirs first, then
/// those absent longest; they can rejoin when there is space. Times are s and must not decrease.
class LoginPolicy {
 public:
  struct Member {
    bool chair = false;
    bool here = false;    ///< present, according to the broker
    bool joined = false;  ///< was present at least once
    double last = 0.0;    ///< s, of the last login or change of presence
  };

  LoginPolicy(MeetingSecrets secrets, LoginRules rules)
      : secrets_(std::move(secrets)), rules_(rules), rate_limit_(rules.rate_limit) {}

  LoginDecision log_in(const std::optional<LoginRequest>& request, const std::string& address, double now);
  /// Records a change of presence that the broker reported.
  void set_presence(const std::string& participant, bool here, double now);
  void lock(bool locked) { locked_ = locked; }

  /// Takes back what a login gave: the broker does not have the account. `chair`: its rights before; nothing:
  /// there was no account.
  void take_back(const std::string& participant, std::optional<bool> chair);

  /// By id.
  const std::map<std::string, Member>& members() const { return members_; }
  const MeetingSecrets& secrets() const { return secrets_; }

 private:
  LoginDecision admit(unsigned number, bool chair, double now);
  bool free_account(double now, std::vector<std::string>& freed);

  MeetingSecrets secrets_;
  LoginRules rules_;
  RateLimit rate_limit_;
  bool locked_ = false;
  std::map<std::string, Member> members_;
};

}  // namespace telemime::meeting
