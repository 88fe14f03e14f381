// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace telemime {

/// A room at a broker.
struct RoomAddress {
  std::string tenant;
  std::string room;
};

enum class RoomTopicKind { pose, state, presence, chat, board, room };

/// One of a room's topics.
struct RoomTopic {
  RoomTopicKind kind = RoomTopicKind::room;
  std::string participant;  ///< whose; empty for `room`
  int page = 0;             ///< of a `board`, 0 to 63
};

inline constexpr int kMostBoardPages = 64;

/// Whether the text may be a tenant, a room or a participant: 1 to 32 of a-z 0-9 _ -.
bool is_room_segment(std::string_view text);

/// The topic's text: "r/<tenant>/<room>/p/<participant>/pose" and the like. Throws Error(usage) when a
/// segment or the page is none.
std::string topic_text(const RoomAddress& room, const RoomTopic& topic);

/// The topic of this text; nothing when it is none of this room's.
std::optional<RoomTopic> read_topic(const RoomAddress& room, std::string_view text);

/// What to subscribe to for the presence of everybody in the room. Throws Error(usage) as above.
std::string presence_filter(const RoomAddress& room);
/// The same for all that is said in the room.
std::string room_filter(const RoomAddress& room);

/// The participant of an account's user name, "<room>.<participant>"; nothing when it is none of this room.
std::optional<std::string> participant_of_user(const RoomAddress& room, std::string_view user);

}  // namespace telemime
