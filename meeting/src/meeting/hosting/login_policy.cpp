// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/login_policy.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "meeting/hosting/crypto.h"

namespace telemime::meeting {
namespace {

using Json = nlohmann::json;

constexpr int kDeepestQuestion = 4;
constexpr std::size_t kLongestText = 500;

/// False: there is one, and it is none that can be meant.
bool take_text(const Json& json, const char* name, std::optional<std::string>& text) {
  if (!json.contains(name) || json[name].is_null()) {
    return true;
  }
  if (!json[name].is_string()) {
    return false;
  }
  text = json[name].get<std::string>();
  return !text->empty() && text->size() <= kLongestText;
}

}  // namespace

std::optional<LoginRequest> read_login_request(std::string_view body) {
  bool deep = false;
  const Json json = Json::parse(
      body,
      [&deep](int depth, Json::parse_event_t, Json&) {
        deep = deep || depth >= kDeepestQuestion;
        return !deep;
      },
      /*allow_exceptions=*/false);
  if (deep || !json.is_object() || !json.contains("v") || json["v"] != 1) {
    return std::nullopt;
  }
  LoginRequest question;
  if (!take_text(json, "invite", question.invite) || !take_text(json, "return", question.rejoin)) {
    return std::nullopt;
  }
  if (json.contains("watch")) {
    if (!json["watch"].is_boolean()) {
      return std::nullopt;
    }
    question.watch = json["watch"].get<bool>();
  }
  return question;
}

LoginDecision LoginPolicy::enter(const std::optional<LoginRequest>& question, const std::string& address,
                                 double now) {
  LoginDecision admission;
  const auto miss = [&](LoginResult answer) {
    admission.answer = tries_.miss(address, now) ? answer : LoginResult::too_many_tries;
    return admission;
  };
  if (!question) {
    return miss(LoginResult::malformed);
  }
  const std::string invite = question->invite.value_or("");
  // All three, whichever it is.
  const bool speaks = same_secret(invite, secrets_.speak);
  const bool watches = same_secret(invite, secrets_.watch);
  const bool chairs = same_secret(invite, secrets_.chair);
  std::optional<RejoinToken> way;
  if (question->rejoin) {
    way = read_rejoin_token(secrets_.key, *question->rejoin);
    if (way && way->number >= secrets_.next) {
      way.reset();
    }
  }
  if (question->invite ? !(speaks || watches || chairs) : !way) {
    return miss(LoginResult::wrong_link);
  }
  if (!tries_.allow(address, now)) {
    admission.answer = LoginResult::too_many_tries;
    return admission;
  }
  const bool chair = chairs || (way && way->chair);
  if (locked_ && !chair && !way) {
    admission.answer = LoginResult::locked;
    return admission;
  }
  if (question->watch || watches) {
    admission.answer = LoginResult::log_in;
    return admission;
  }
  return admit(way ? way->number : secrets_.next, chair, now);
}

LoginDecision LoginPolicy::admit(unsigned number, bool chair, double now) {
  LoginDecision admission;
  const std::string id = participant_id(number);
  auto member = members_.find(id);
  if (member == members_.end()) {
    if (!free_account(now, admission.freed)) {
      admission.answer = LoginResult::full;
      return admission;
    }
    member = members_.emplace(id, Member{chair, false, false, now}).first;
    admission.changed = true;
    secrets_.next = std::max(secrets_.next, number + 1);
  }
  admission.changed = admission.changed || member->second.chair != (member->second.chair || chair);
  member->second.chair = member->second.chair || chair;
  member->second.last = now;
  admission.answer = LoginResult::log_in;
  admission.participant = id;
  admission.chair = member->second.chair;
  admission.rejoin = write_rejoin_token(secrets_.key, {number, admission.chair});
  return admission;
}

bool LoginPolicy::free_account(double now, std::vector<std::string>& freed) {
  if (members_.size() < rules_.most) {
    return true;
  }
  const auto may_go = [&](const Member& m) {
    return !m.here &&
           now - m.last >= (m.came ? rules_.keeps_seat : std::min(rules_.comes_within, rules_.keeps_seat));
  };
  auto gone = members_.end();
  for (auto it = members_.begin(); it != members_.end(); ++it) {
    const Member& m = it->second;
    if (may_go(m) && (gone == members_.end() ||
                      std::pair(m.came, m.last) < std::pair(gone->second.came, gone->second.last))) {
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

void LoginPolicy::seen(const std::string& participant, bool here, double now) {
  const auto member = members_.find(participant);
  if (member != members_.end()) {
    member->second.here = here;
    member->second.came = member->second.came || here;
    member->second.last = now;
  }
}

}  // namespace telemime::meeting
