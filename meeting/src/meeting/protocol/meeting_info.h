// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace telemime::meeting {

/// The meeting itself: the message `room` (meeting/docs/protocol.md).
struct MeetingInfo {
  std::string title;
  int seats = 8;  ///< chairs at the table, 1 to 100
  std::uint32_t epoch = 1;
  std::vector<std::string> chairs;  ///< participants who chair the meeting
  bool locked = false;

  bool operator==(const MeetingInfo&) const = default;
};

/// JSON without line breaks.
std::string write_meeting_info(const MeetingInfo& meeting);

/// Returns nothing when the bytes are not such a message, or more than 8192. Never throws.
std::optional<MeetingInfo> read_meeting_info(std::string_view bytes);

/// The meeting after the message `received`: it may change everything but the chairs, with the same epoch or
/// a higher one. Returns nothing when it changes nothing.
std::optional<MeetingInfo> after_change(const MeetingInfo& own, const std::optional<MeetingInfo>& received);

/// The epoch in a message `room` or a page of the blackboard. Returns nothing when there is none.
std::optional<std::uint32_t> read_epoch(std::string_view payload);

/// The page of the blackboard with another epoch. Returns nothing when the payload is not a page.
std::optional<std::string> page_with_epoch(std::string_view payload, std::uint32_t epoch);

}  // namespace telemime::meeting
