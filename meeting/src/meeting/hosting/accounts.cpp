// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/accounts.h"

#include <charconv>

#include "meeting/hosting/crypto.h"

namespace telemime::meeting {
namespace {

constexpr std::string_view kSpeaker = "s";
constexpr std::string_view kChair = "c";
constexpr std::string_view kWatcher = "watch";
constexpr std::size_t kMostDigits = 9;

/// The signed part: "12.s".
std::string body_of(const RejoinToken& token) {
  return std::to_string(token.number) + "." + std::string(token.chair ? kChair : kSpeaker);
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

std::string write_rejoin_token(std::string_view key, const RejoinToken& token) {
  return body_of(token) + "." + signature(key, "way back " + body_of(token));
}

std::optional<RejoinToken> read_rejoin_token(std::string_view key, std::string_view text) {
  const std::string_view digits = text.substr(0, text.find('.'));
  if (digits.empty() || digits.size() > kMostDigits || text.size() < digits.size() + 3) {
    return std::nullopt;
  }
  RejoinToken token;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), token.number);
  token.chair = text.substr(digits.size() + 1, 1) == kChair;
  const bool read = error == std::errc() && end == digits.data() + digits.size() && token.number > 0;
  return read && same_secret(text, write_rejoin_token(key, token)) ? std::optional(token) : std::nullopt;
}

std::string topic_base(const MeetingAddress& meeting) {
  std::string base = topic_text(meeting, {TopicKind::meeting, "", 0});
  return base.substr(0, base.rfind('/'));
}

// The pages of the blackboard are listed one by one: a wildcard would allow any number of retained messages.
// The meeting comes first, because the broker searches the list from its start for every message that it
// delivers.
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
