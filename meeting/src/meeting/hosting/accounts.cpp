// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/accounts.h"

#include <algorithm>
#include <charconv>

#include "meeting/hosting/random_text.h"

namespace telemime {
namespace {

constexpr std::string_view kSpeaker = "s";
constexpr std::string_view kChair = "c";
constexpr std::string_view kWatcher = "watch";
constexpr std::size_t kMostDigits = 9;

/// "12.s": what is signed.
std::string body_of(const WayBack& way) {
  return std::to_string(way.number) + "." + std::string(way.chair ? kChair : kSpeaker);
}

std::string user_of(const RoomAddress& room, std::string_view who) {
  return room.room + "." + std::string(who);
}

}  // namespace

std::string participant_id(unsigned number) {
  return (number < 10 ? "p0" : "p") + std::to_string(number);
}

std::string participant_password(std::string_view key, const std::string& participant) {
  return signature(key, "password " + participant);
}

std::string way_back_text(std::string_view key, const WayBack& way) {
  return body_of(way) + "." + signature(key, "way back " + body_of(way));
}

std::optional<WayBack> read_way_back(std::string_view key, std::string_view text) {
  const std::string_view digits = text.substr(0, text.find('.'));
  if (digits.empty() || digits.size() > kMostDigits || text.size() < digits.size() + 3) {
    return std::nullopt;
  }
  WayBack way;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), way.number);
  way.chair = text.substr(digits.size() + 1, 1) == kChair;
  const bool read = error == std::errc() && end == digits.data() + digits.size() && way.number > 0;
  return read && same_secret(text, way_back_text(key, way)) ? std::optional(way) : std::nullopt;
}

std::string room_base(const RoomAddress& room) {
  std::string base = topic_text(room, {RoomTopicKind::room, "", 0});
  return base.substr(0, base.rfind('/'));
}

// Pages of the blackboard are named one by one: with a wildcard somebody could have the broker keep any
// number of messages. The room stands first: for every message that is delivered the list is gone through
// from its start.
BrokerAccount participant_account(const RoomAddress& room, std::string_view key,
                                  const std::string& participant, bool chair) {
  BrokerAccount account{
      user_of(room, participant), participant_password(key, participant), {room_base(room) + "/#"}, {}};
  for (const RoomTopicKind kind :
       {RoomTopicKind::pose, RoomTopicKind::state, RoomTopicKind::presence, RoomTopicKind::chat}) {
    account.write.push_back(topic_text(room, {kind, participant, 0}));
  }
  if (chair) {
    account.write.push_back(topic_text(room, {RoomTopicKind::room, "", 0}));
  }
  for (int page = 0; page < kMostBoardPages; ++page) {
    account.write.push_back(topic_text(room, {RoomTopicKind::board, participant, page}));
  }
  return account;
}

BrokerAccount watcher_account(const RoomAddress& room, std::string_view key) {
  return {user_of(room, kWatcher), signature(key, "password watch"), {room_base(room) + "/#"}, {}};
}

BrokerAccount service_account(const RoomAddress& room) {
  const std::string all = room_base(room) + "/#";
  return {user_of(room, "service"), random_secret(), {all}, {all}};
}

}  // namespace telemime
