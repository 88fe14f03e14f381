// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace telemime::meeting {

/// What a room is: the message `room` (docs/room-page.md).
struct MeetingInfo {
  std::string title;
  int seats = 8;  ///< chairs at the table, 1 to 100
  std::uint32_t epoch = 1;
  std::vector<std::string> chairs;  ///< ids of participants
  bool locked = false;
  bool operator==(const MeetingInfo&) const = default;
};

/// JSON without line breaks.
std::string write_meeting_info(const MeetingInfo& meeting);
/// Nothing when the bytes are no such message, or more than 8192. Never throws.
std::optional<MeetingInfo> read_meeting_info(std::string_view bytes);

/// What the room is after `told` was heard of it: a chair may change all but who is a chair, with the same
/// epoch or a higher one. Nothing when it is as `own` says.
std::optional<MeetingInfo> after_change(const MeetingInfo& own, const std::optional<MeetingInfo>& told);

}  // namespace telemime::meeting
