// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/meeting_info.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "meeting/protocol/messages.h"
#include "meeting/protocol/topics.h"

namespace telemime::meeting {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kLongestRoom = 8192;
constexpr std::size_t kLongestTitle = 200;  // bytes
constexpr int kDeepestRoom = 8;

template <class Number>
std::optional<Number> whole(const Json& json, const char* name, std::uint64_t least, std::uint64_t most) {
  if (!json.contains(name) || !json[name].is_number_unsigned()) {
    return std::nullopt;
  }
  const auto number = json[name].get<std::uint64_t>();
  return number >= least && number <= most ? std::optional(static_cast<Number>(number)) : std::nullopt;
}

}  // namespace

std::string write_meeting_info(const MeetingInfo& meeting) {
  const Json json = {{"v", 1},
                     {"title", meeting.title},
                     {"seats", meeting.seats},
                     {"epoch", meeting.epoch},
                     {"chairs", meeting.chairs},
                     {"locked", meeting.locked}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<MeetingInfo> read_meeting_info(std::string_view bytes) {
  if (bytes.size() > kLongestRoom) {
    return std::nullopt;
  }
  bool deep = false;
  const Json json = Json::parse(
      bytes,
      [&deep](int depth, Json::parse_event_t, Json&) {
        deep = deep || depth >= kDeepestRoom;
        return !deep;
      },
      /*allow_exceptions=*/false);
  if (deep || !json.is_object() || !json.contains("v") || json["v"] != 1) {
    return std::nullopt;
  }
  MeetingInfo meeting;
  const auto epoch = whole<std::uint32_t>(json, "epoch", 0, 4294967295U);
  if (!epoch) {
    return std::nullopt;
  }
  meeting.epoch = *epoch;
  meeting.seats = whole<int>(json, "seats", 1, kMostSeats).value_or(meeting.seats);
  if (json.contains("title") && json["title"].is_string()) {
    meeting.title = json["title"].get<std::string>();
    if (meeting.title.size() > kLongestTitle) {
      return std::nullopt;
    }
  }
  if (json.contains("chairs") && json["chairs"].is_array()) {
    for (const Json& chair : json["chairs"]) {
      if (chair.is_string() && is_topic_segment(chair.get<std::string>())) {
        meeting.chairs.push_back(chair.get<std::string>());
      }
    }
  }
  meeting.locked = json.contains("locked") && json["locked"] == true;
  return meeting;
}

std::optional<MeetingInfo> after_change(const MeetingInfo& own, const std::optional<MeetingInfo>& told) {
  if (!told || told->epoch < own.epoch) {
    return std::nullopt;
  }
  MeetingInfo now = *told;
  now.chairs = own.chairs;
  return now == own ? std::nullopt : std::optional(now);
}

}  // namespace telemime::meeting
