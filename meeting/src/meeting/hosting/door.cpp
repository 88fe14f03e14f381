// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/door.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "meeting/hosting/random_text.h"

namespace telemime {
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

std::optional<EntryQuestion> read_question(std::string_view body) {
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
  EntryQuestion question;
  if (!take_text(json, "invite", question.invite) || !take_text(json, "return", question.way_back)) {
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

Admission Door::enter(const std::optional<EntryQuestion>& question, const std::string& address, double now) {
  Admission admission;
  const auto miss = [&](DoorAnswer answer) {
    admission.answer = tries_.miss(address, now) ? answer : DoorAnswer::too_many_tries;
    return admission;
  };
  if (!question) {
    return miss(DoorAnswer::malformed);
  }
  const std::string invite = question->invite.value_or("");
  // All three, whichever it is.
  const bool speaks = same_secret(invite, secrets_.speak);
  const bool watches = same_secret(invite, secrets_.watch);
  const bool chairs = same_secret(invite, secrets_.chair);
  std::optional<WayBack> way;
  if (question->way_back) {
    way = read_way_back(secrets_.key, *question->way_back);
    if (way && way->number >= secrets_.next) {
      way.reset();
    }
  }
  if (question->invite ? !(speaks || watches || chairs) : !way) {
    return miss(DoorAnswer::wrong_link);
  }
  if (!tries_.allow(address, now)) {
    admission.answer = DoorAnswer::too_many_tries;
    return admission;
  }
  const bool chair = chairs || (way && way->chair);
  if (locked_ && !chair && !way) {
    admission.answer = DoorAnswer::locked;
    return admission;
  }
  if (question->watch || watches) {
    admission.answer = DoorAnswer::come_in;
    return admission;
  }
  return admit(way ? way->number : secrets_.next, chair, now);
}

Admission Door::admit(unsigned number, bool chair, double now) {
  Admission admission;
  const std::string id = participant_id(number);
  auto member = members_.find(id);
  if (member == members_.end()) {
    if (!make_room(now, admission.freed)) {
      admission.answer = DoorAnswer::full;
      return admission;
    }
    member = members_.emplace(id, Member{chair, false, false, now}).first;
    admission.changed = true;
    secrets_.next = std::max(secrets_.next, number + 1);
  }
  admission.changed = admission.changed || member->second.chair != (member->second.chair || chair);
  member->second.chair = member->second.chair || chair;
  member->second.last = now;
  admission.answer = DoorAnswer::come_in;
  admission.participant = id;
  admission.chair = member->second.chair;
  admission.way_back = way_back_text(secrets_.key, {number, admission.chair});
  return admission;
}

bool Door::make_room(double now, std::vector<std::string>& freed) {
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

void Door::seen(const std::string& participant, bool here, double now) {
  const auto member = members_.find(participant);
  if (member != members_.end()) {
    member->second.here = here;
    member->second.came = member->second.came || here;
    member->second.last = now;
  }
}

}  // namespace telemime
