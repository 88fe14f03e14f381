// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "meeting/hosting/accounts.h"
#include "meeting/hosting/rate_limit.h"
#include "meeting/hosting/secrets.h"

namespace telemime::meeting {

/// What the body of POST /room/enter asks for (docs/room-page.md, "Coming in").
struct LoginRequest {
  std::optional<std::string> invite;
  std::optional<std::string> rejoin;
  bool watch = false;
};

/// Nothing when the bytes are no such question. Members that are not known are ignored. Never throws.
std::optional<LoginRequest> read_login_request(std::string_view body);

/// HTTP's numbers for what the door says.
enum class LoginResult {
  log_in = 200,
  malformed = 400,
  wrong_link = 403,
  full = 409,
  locked = 423,
  too_many_tries = 429,
};

struct LoginDecision {
  LoginResult answer = LoginResult::malformed;
  std::string participant;  ///< empty: only watches
  bool chair = false;
  std::string rejoin;              ///< of a participant
  bool changed = false;            ///< the accounts are others now: the broker must hear of it
  std::vector<std::string> freed;  ///< participants whose accounts are gone
};

struct LoginRules {
  std::size_t most = 40;      ///< participants who have an account at once
  double keeps_seat = 300.0;  ///< s that somebody may be away while others wait for an account
  double comes_within =
      30.0;  ///< s for which an account is kept for who has not come yet; at most keeps_seat
  RateLimitOptions rates;
};

/// Who may come in, and as whom. A newcomer is a participant that there never was before; who comes back is
/// who they were. When there are no more accounts, those go who never came, then who have been away longest;
/// they can come back, too, as soon as there is room. Time is told, s, and never goes back.
class LoginPolicy {
 public:
  struct Member {
    bool chair = false;
    bool here = false;  ///< as the broker tells
    bool came = false;  ///< was here once
    double last = 0.0;  ///< s: came in, or was seen
  };

  LoginPolicy(MeetingSecrets secrets, LoginRules rules)
      : secrets_(std::move(secrets)), rules_(rules), tries_(rules.rates) {}

  LoginDecision enter(const std::optional<LoginRequest>& question, const std::string& address, double now);
  /// The broker tells that a participant is here, or gone.
  void seen(const std::string& participant, bool here, double now);
  void lock(bool locked) { locked_ = locked; }

  /// By their ids.
  const std::map<std::string, Member>& members() const { return members_; }
  const MeetingSecrets& secrets() const { return secrets_; }

 private:
  LoginDecision admit(unsigned number, bool chair, double now);
  bool free_account(double now, std::vector<std::string>& freed);

  MeetingSecrets secrets_;
  LoginRules rules_;
  RateLimit tries_;
  bool locked_ = false;
  std::map<std::string, Member> members_;
};

}  // namespace telemime::meeting
