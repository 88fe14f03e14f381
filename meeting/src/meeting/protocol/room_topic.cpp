// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/room_topic.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

constexpr std::size_t kLongestSegment = 32;
constexpr std::string_view kBoard = "board/";

constexpr std::array<std::pair<std::string_view, RoomTopicKind>, 4> kOfParticipant = {
    {{"pose", RoomTopicKind::pose},
     {"state", RoomTopicKind::state},
     {"presence", RoomTopicKind::presence},
     {"chat", RoomTopicKind::chat}}};

const std::string& checked(const std::string& segment) {
  if (!is_room_segment(segment)) {
    throw Error(ErrorKind::usage,
                "\"" + segment + "\" cannot be the name of a tenant, a room or a participant",
                "Such a name is 1 to 32 small letters, digits, _ and -.");
  }
  return segment;
}

std::string prefix_of(const RoomAddress& room) {
  return "r/" + checked(room.tenant) + "/" + checked(room.room) + "/";
}

// Pages have one spelling each: no signs, no leading zeros.
std::optional<int> read_page(std::string_view text) {
  int page = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), page);
  if (error != std::errc() || page < 0 || page >= kMostBoardPages || std::to_string(page) != text) {
    return std::nullopt;
  }
  return page;
}

bool take(std::string_view& text, std::string_view start) {
  if (!text.starts_with(start)) {
    return false;
  }
  text.remove_prefix(start.size());
  return true;
}

}  // namespace

bool is_room_segment(std::string_view text) {
  return !text.empty() && text.size() <= kLongestSegment && std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

std::string topic_text(const RoomAddress& room, const RoomTopic& topic) {
  if (topic.kind == RoomTopicKind::room) {
    return prefix_of(room) + "room";
  }
  const std::string below = prefix_of(room) + "p/" + checked(topic.participant) + "/";
  if (topic.kind == RoomTopicKind::board) {
    if (topic.page < 0 || topic.page >= kMostBoardPages) {
      throw Error(ErrorKind::usage, "a board has no page " + std::to_string(topic.page));
    }
    return below + std::string(kBoard) + std::to_string(topic.page);
  }
  const auto* const named = std::find_if(kOfParticipant.begin(), kOfParticipant.end(),
                                         [&](const auto& entry) { return entry.second == topic.kind; });
  return below + std::string(named->first);
}

std::optional<RoomTopic> read_topic(const RoomAddress& room, std::string_view text) {
  if (!take(text, prefix_of(room))) {
    return std::nullopt;
  }
  if (text == "room") {
    return RoomTopic{};
  }
  if (!take(text, "p/")) {
    return std::nullopt;
  }
  RoomTopic topic;
  topic.participant = text.substr(0, text.find('/'));
  if (!is_room_segment(topic.participant) || topic.participant.size() == text.size()) {
    return std::nullopt;
  }
  text.remove_prefix(topic.participant.size() + 1);
  for (const auto& [name, kind] : kOfParticipant) {
    if (text == name) {
      topic.kind = kind;
      return topic;
    }
  }
  if (!take(text, kBoard)) {
    return std::nullopt;
  }
  const auto page = read_page(text);
  if (!page) {
    return std::nullopt;
  }
  topic.kind = RoomTopicKind::board;
  topic.page = *page;
  return topic;
}

std::string presence_filter(const RoomAddress& room) {
  return prefix_of(room) + "p/+/presence";
}

std::string room_filter(const RoomAddress& room) {
  return prefix_of(room) + "#";
}

std::optional<std::string> participant_of_user(const RoomAddress& room, std::string_view user) {
  if (!take(user, room.room + ".") || !is_room_segment(user)) {
    return std::nullopt;
  }
  return std::string(user);
}

}  // namespace telemime
