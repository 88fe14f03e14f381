// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/login_policy.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <utility>

#include "meeting/hosting/crypto.h"
#include "telemime/core/json_field.h"

namespace telemime::meeting {
namespace {

constexpr std::size_t kLongestText = 500;

/// The address, or the network of an IPv6 address.
std::string network_of(const std::string& text) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(text, error);
  if (error || !address.is_v6()) {
    return text;
  }
  auto bytes = address.to_v6().to_bytes();
  std::fill(bytes.begin() + bytes.size() / 2, bytes.end(), static_cast<unsigned char>(0));
  return boost::asio::ip::make_address_v6(bytes).to_string();
}

/// An optional text; null counts as missing.
std::optional<std::string> text_of(const JsonField& json, const char* name) {
  if (!json.has(name) || json[name].value().is_null()) {
    return std::nullopt;
  }
  const std::string text = json[name].text(kLongestText);
  if (text.empty()) {
    json[name].fail("is empty");
  }
  return text;
}

}  // namespace

RateLimit::Left& RateLimit::of(const std::string& address, double now) {
  const std::string network = network_of(address);
  auto found = left_.find(network);
  if (found == left_.end()) {
    if (left_.size() >= options_.most_addresses) {  // forget the oldest
      const auto oldest = std::min_element(
          left_.begin(), left_.end(), [](const auto& a, const auto& b) { return a.second.at < b.second.at; });
      left_.erase(oldest);
    }
    found = left_.emplace(network, Left{options_.attempts, options_.failures, now}).first;
  }
  Left& left = found->second;
  const double passed = std::max(0.0, now - left.at);
  left.attempts = std::min(options_.attempts, left.attempts + passed * options_.attempts_per_second);
  left.failures = std::min(options_.failures, left.failures + passed * options_.failures_per_second);
  left.at = std::max(left.at, now);
  return left;
}

bool RateLimit::take(double& left) {
  const bool any = left >= 1.0;
  left -= any ? 1.0 : 0.0;
  return any;
}

std::optional<LoginRequest> read_login_request(std::string_view body) {
  const JsonSource source{.name = "the request", .kind = ErrorKind::input, .remedy = "", .deepest = 3};
  return read_if_valid(body, source, [](const JsonField& json) {
    json["v"].integer(1, 1);
    return LoginRequest{.invite = text_of(json, "invite"),
                        .rejoin = text_of(json, "return"),
                        .watch = json.has("watch") && json["watch"].boolean()};
  });
}

LoginDecision LoginPolicy::log_in(const std::optional<LoginRequest>& request, const std::string& address,
                                  double now) {
  LoginDecision decision;
  const auto decide = [&decision](LoginResult result) {
    decision.result = result;
    return decision;
  };
  const auto fail = [&](LoginResult result) {
    return decide(rate_limit_.allow_failure(address, now) ? result : LoginResult::too_many_attempts);
  };
  if (!request) {
    return fail(LoginResult::malformed);
  }

  // The link: all three secrets are compared, whichever matches, so that the time reveals nothing.
  const std::string invite = request->invite.value_or("");
  const bool speaks = same_secret(invite, secrets_.speak);
  const bool watches = same_secret(invite, secrets_.watch);
  const bool chairs = same_secret(invite, secrets_.chair);

  // The rejoin token.
  std::optional<RejoinToken> token;
  if (request->rejoin) {
    token = read_rejoin_token(secrets_.key, *request->rejoin);
    if (token && token->number >= secrets_.next) {
      token.reset();
    }
  }
  if (request->invite ? !(speaks || watches || chairs) : !token) {
    return fail(LoginResult::wrong_link);
  }
  if (!rate_limit_.allow(address, now)) {
    return decide(LoginResult::too_many_attempts);
  }
  const bool chair = chairs || (token && token->chair);
  if (locked_ && !chair && !token) {
    return decide(LoginResult::locked);
  }
  if (request->watch || watches) {
    return decide(LoginResult::accepted);
  }
  return admit(token ? token->number : secrets_.next, chair, now);
}

LoginDecision LoginPolicy::admit(unsigned number, bool chair, double now) {
  LoginDecision decision;
  const std::string id = participant_id(number);
  auto found = members_.find(id);
  if (found == members_.end()) {
    if (!free_account(now, decision.freed)) {
      decision.result = LoginResult::full;
      return decision;
    }
    found = members_.emplace(id, Member{chair, false, false, now}).first;
    secrets_.next = std::max(secrets_.next, number + 1);
  }
  Member& member = found->second;
  member.chair = member.chair || chair;
  member.last = now;
  decision.result = LoginResult::accepted;
  decision.participant = id;
  decision.chair = member.chair;
  decision.rejoin = write_rejoin_token(secrets_.key, {number, member.chair});
  return decision;
}

void LoginPolicy::take_back(const std::string& participant, std::optional<bool> chair) {
  const auto found = members_.find(participant);
  if (found != members_.end() && chair) {
    found->second.chair = *chair;
  } else if (found != members_.end()) {
    members_.erase(found);
  }
}

bool LoginPolicy::free_account(double now, std::vector<std::string>& freed) {
  if (members_.size() < rules_.most) {
    return true;
  }
  const auto removable = [&](const Member& m) {
    const double limit = m.joined ? rules_.keeps_seat : std::min(rules_.joins_within, rules_.keeps_seat);
    return !m.here && now - m.last >= limit;
  };
  auto gone = members_.end();
  for (auto it = members_.begin(); it != members_.end(); ++it) {
    const Member& m = it->second;
    if (removable(m) && (gone == members_.end() ||
                         std::pair(m.joined, m.last) < std::pair(gone->second.joined, gone->second.last))) {
      gone = it;
    }
  }
  if (gone == members_.end()) {
    return false;
  }
  freed.push_back(gone->first);
  members_.erase(gone);
  return true;
}

void LoginPolicy::set_presence(const std::string& participant, bool here, double now) {
  const auto found = members_.find(participant);
  if (found != members_.end()) {
    Member& member = found->second;
    member.here = here;
    member.joined = member.joined || here;
    member.last = now;
  }
}

}  // namespace telemime::meeting
