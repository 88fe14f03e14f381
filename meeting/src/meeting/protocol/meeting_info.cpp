// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/meeting_info.h"

#include "meeting/protocol/json.h"
#include "meeting/protocol/messages.h"
#include "meeting/protocol/topics.h"

namespace telemime::meeting {
namespace {

constexpr std::size_t kLongestInfo = 8192;  // bytes
constexpr std::size_t kLongestTitle = 200;  // bytes

std::optional<std::uint32_t> epoch_of(const Json& json) {
  const auto epoch = whole_member(json, "epoch", 0, UINT32_MAX);
  return epoch ? std::optional(static_cast<std::uint32_t>(*epoch)) : std::nullopt;
}

}  // namespace

std::string write_meeting_info(const MeetingInfo& meeting) {
  const nlohmann::json json = {{"v", 1},
                               {"title", meeting.title},
                               {"seats", meeting.seats},
                               {"epoch", meeting.epoch},
                               {"chairs", meeting.chairs},
                               {"locked", meeting.locked}};
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::optional<MeetingInfo> read_meeting_info(std::string_view bytes) {
  const Json json = bytes.size() <= kLongestInfo ? parse_object(bytes) : Json();
  const auto epoch = epoch_of(json);
  MeetingInfo meeting;
  meeting.title = text_member(json, "title");
  if (!whole_member(json, "v", 1, 1) || !epoch || meeting.title.size() > kLongestTitle) {
    return std::nullopt;
  }
  meeting.epoch = *epoch;
  meeting.seats = static_cast<int>(whole_member(json, "seats", 1, kMostSeats).value_or(meeting.seats));
  if (const Json& chairs = member(json, "chairs"); chairs.is_array()) {
    for (const Json& chair : chairs) {
      if (chair.is_string() && is_topic_segment(chair.get_ref<const std::string&>())) {
        meeting.chairs.push_back(chair.get<std::string>());
      }
    }
  }
  meeting.locked = member(json, "locked") == true;
  return meeting;
}

std::optional<MeetingInfo> after_change(const MeetingInfo& own, const std::optional<MeetingInfo>& received) {
  if (!received || received->epoch < own.epoch) {
    return std::nullopt;
  }
  MeetingInfo now = *received;
  now.chairs = own.chairs;
  return now == own ? std::nullopt : std::optional(now);
}

std::optional<std::uint32_t> read_epoch(std::string_view payload) {
  return epoch_of(parse_object(payload));
}

std::optional<std::string> page_with_epoch(std::string_view payload, std::uint32_t epoch) {
  Json json = parse_object(payload);
  if (!epoch_of(json)) {
    return std::nullopt;
  }
  json["epoch"] = epoch;
  std::string text = json.dump();
  return text.size() <= kLongestPayload ? std::optional(std::move(text)) : std::nullopt;
}

}  // namespace telemime::meeting
