// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/meeting_info.h"

#include "meeting/protocol/messages.h"
#include "meeting/protocol/topics.h"

namespace telemime::meeting {
namespace {

constexpr std::size_t kLongestInfo = 8192;  // bytes
constexpr std::size_t kLongestTitle = 200;  // bytes

std::uint32_t epoch_of(const JsonField& json) {
  return static_cast<std::uint32_t>(json["epoch"].integer(0, UINT32_MAX));
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
  if (bytes.size() > kLongestInfo) {
    return std::nullopt;
  }
  return read_if_valid(bytes, kMessageSource, [](const JsonField& json) {
    json["v"].integer(1, 1);
    MeetingInfo meeting;
    meeting.epoch = epoch_of(json);
    meeting.title = json.optional("title", [](const JsonField& f) { return f.text(); }).value_or("");
    if (meeting.title.size() > kLongestTitle) {
      json.fail("has too long a title");
    }
    const auto seats = json.optional("seats", [](const JsonField& f) { return f.integer(1, kMostSeats); });
    meeting.seats = static_cast<int>(seats.value_or(meeting.seats));
    const nlohmann::json chairs = json.value().value("chairs", nlohmann::json());
    for (std::size_t i = 0; i < chairs.size() && chairs.is_array(); ++i) {
      if (chairs[i].is_string() && is_topic_segment(chairs[i].get_ref<const std::string&>())) {
        meeting.chairs.push_back(chairs[i].get<std::string>());
      }
    }
    meeting.locked = json.value().value("locked", nlohmann::json()) == true;
    return meeting;
  });
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
  return read_if_valid(payload, kMessageSource, epoch_of);
}

std::optional<std::string> page_with_epoch(std::string_view payload, std::uint32_t epoch) {
  const auto text = read_if_valid(payload, kMessageSource, [&](const JsonField& page) {
    epoch_of(page);
    nlohmann::json json = page.value();
    json["epoch"] = epoch;
    return json.dump();
  });
  return text && text->size() <= kLongestPayload ? text : std::nullopt;
}

}  // namespace telemime::meeting
