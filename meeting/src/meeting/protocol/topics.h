// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace telemime::meeting {

/// A room at a broker.
struct MeetingAddress {
  std::string tenant;
  std::string meeting;
};

enum class TopicKind { pose, state, presence, chat, board, meeting };

/// One of a room's topics.
struct Topic {
  TopicKind kind = TopicKind::meeting;
  std::string participant;  ///< whose; empty for `room`
  int page = 0;             ///< of a `board`, 0 to 63
};

inline constexpr int kMostBoardPages = 64;

/// Whether the text may be a tenant, a room or a participant: 1 to 32 of a-z 0-9 _ -.
bool is_topic_segment(std::string_view text);

/// The topic's text: "r/<tenant>/<room>/p/<participant>/pose" and the like. Throws Error(usage) when a
/// segment or the page is none.
std::string topic_text(const MeetingAddress& meeting, const Topic& topic);

/// The topic of this text; nothing when it is none of this room's.
std::optional<Topic> read_topic(const MeetingAddress& meeting, std::string_view text);

/// What to subscribe to for the presence of everybody in the room. Throws Error(usage) as above.
std::string presence_filter(const MeetingAddress& meeting);
/// The same for all that is said in the room.
std::string meeting_filter(const MeetingAddress& meeting);

/// The participant of an account's user name, "<room>.<participant>"; nothing when it is none of this room.
std::optional<std::string> participant_of_user(const MeetingAddress& meeting, std::string_view user);

}  // namespace telemime::meeting
