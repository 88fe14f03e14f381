// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace telemime::meeting {

/// A meeting at a broker. Its topics begin with "r/<tenant>/<meeting>/".
struct MeetingAddress {
  std::string tenant;
  std::string meeting;
};

/// What the messages of a topic say; `meeting` describes the meeting itself (topic "room").
enum class TopicKind { pose, state, presence, chat, board, meeting };

/// One topic of a meeting.
struct Topic {
  TopicKind kind = TopicKind::meeting;
  std::string participant;  ///< whose topic it is; empty for `meeting`
  int page = 0;             ///< of a `board`, 0 to kMostBoardPages - 1
};

inline constexpr int kMostBoardPages = 64;
/// Maximum size of the payload of any message, bytes; longer ones are ignored.
inline constexpr std::size_t kLongestPayload = 16384;

/// Whether the text can name a tenant, a meeting or a participant: 1 to 32 of a-z 0-9 _ -.
bool is_topic_segment(std::string_view text);

/// The text of a topic, such as "r/<tenant>/<meeting>/p/<participant>/pose". Throws Error(usage) when a
/// segment or the page is invalid.
std::string topic_text(const MeetingAddress& meeting, const Topic& topic);

/// Parses the text of a topic. Returns nothing when it is not a topic of this meeting.
std::optional<Topic> read_topic(const MeetingAddress& meeting, std::string_view text);

/// The subscription filter for the presence of all participants. Throws Error(usage) as above.
std::string presence_filter(const MeetingAddress& meeting);

/// The subscription filter for all messages of the meeting.
std::string meeting_filter(const MeetingAddress& meeting);

/// The participant of a user name "<meeting>.<participant>". Returns nothing for other users.
std::optional<std::string> participant_of_user(const MeetingAddress& meeting, std::string_view user);

}  // namespace telemime::meeting
