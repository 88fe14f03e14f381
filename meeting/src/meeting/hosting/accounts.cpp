// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/accounts.h"

#include <algorithm>
#include <charconv>

#include "meeting/hosting/crypto.h"

namespace telemime::meeting {
namespace {

constexpr std::string_view kSpeaker = "s";
constexpr std::string_view kChair = "c";
constexpr std::string_view kWatcher = "watch";
constexpr std::size_t kMostDigits = 9;

/// "12.s": what is signed.
std::string body_of(const RejoinToken& way) {
  return std::to_string(way.number) + "." + std::string(way.chair ? kChair : kSpeaker);
}

std::string user_of(const MeetingAddress& meeting, std::string_view who) {
  return meeting.meeting + "." + std::string(who);
}

}  // namespace

std::string participant_id(unsigned number) {
  return (number < 10 ? "p0" : "p") + std::to_string(number);
}

std::string participant_password(std::string_view key, const std::string& participant) {
  return signature(key, "password " + participant);
}

std::string write_rejoin_token(std::string_view key, const RejoinToken& way) {
  return body_of(way) + "." + signature(key, "way back " + body_of(way));
}

std::optional<RejoinToken> read_rejoin_token(std::string_view key, std::string_view text) {
  const std::string_view digits = text.substr(0, text.find('.'));
  if (digits.empty() || digits.size() > kMostDigits || text.size() < digits.size() + 3) {
    return std::nullopt;
  }
  RejoinToken way;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), way.number);
  way.chair = text.substr(digits.size() + 1, 1) == kChair;
  const bool read = error == std::errc() && end == digits.data() + digits.size() && way.number > 0;
  return read && same_secret(text, write_rejoin_token(key, way)) ? std::optional(way) : std::nullopt;
}

std::string topic_base(const MeetingAddress& meeting) {
  std::string base = topic_text(meeting, {TopicKind::meeting, "", 0});
  return base.substr(0, base.rfind('/'));
}

// Pages of the blackboard are named one by one: with a wildcard somebody could have the broker keep any
// number of messages. The room stands first: for every message that is delivered the list is gone through
// from its start.
BrokerAccount participant_account(const MeetingAddress& meeting, std::string_view key,
                                  const std::string& participant, bool chair) {
  BrokerAccount account{user_of(meeting, participant),
                        participant_password(key, participant),
                        {topic_base(meeting) + "/#"},
                        {}};
  for (const TopicKind kind : {TopicKind::pose, TopicKind::state, TopicKind::presence, TopicKind::chat}) {
    account.write.push_back(topic_text(meeting, {kind, participant, 0}));
  }
  if (chair) {
    account.write.push_back(topic_text(meeting, {TopicKind::meeting, "", 0}));
  }
  for (int page = 0; page < kMostBoardPages; ++page) {
    account.write.push_back(topic_text(meeting, {TopicKind::board, participant, page}));
  }
  return account;
}

BrokerAccount watcher_account(const MeetingAddress& meeting, std::string_view key) {
  return {user_of(meeting, kWatcher), signature(key, "password watch"), {topic_base(meeting) + "/#"}, {}};
}

BrokerAccount service_account(const MeetingAddress& meeting) {
  const std::string all = topic_base(meeting) + "/#";
  return {user_of(meeting, "service"), random_secret(), {all}, {all}};
}

}  // namespace telemime::meeting
