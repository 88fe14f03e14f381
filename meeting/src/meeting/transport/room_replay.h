// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "meeting/protocol/session_reader.h"
#include "meeting/transport/replay_voice.h"
#include "meeting/transport/room_door.h"

namespace telemime {

/// Participants that are replayed at once, at most.
inline constexpr std::size_t kMostReplayed = 100;

struct ReplayOptions {
  std::filesystem::path file;
  std::string to;              ///< a room's link, or a broker's URL
  std::filesystem::path ca;    ///< as RoomEntry::ca
  double speed = 1.0;          ///< 0.1 to 100
  bool loop = false;           ///< from the beginning again, until it is stopped
  std::set<std::string> only;  ///< participants' or people's names; everybody when empty
  RoomDoor::Enter enter = enter_room;
};

/// What became of a participant of the recording.
struct ReplayedPerson {
  std::string recorded;     ///< whose messages these were
  std::string participant;  ///< who says them now
  std::set<std::string> names;
  ReplayVoice::Status status;
};

/// Plays a recording into a room: each of its participants comes in as one of its own, says what was said at
/// its time, and leaves at the end. Frames that the broker cannot take in time are dropped; times do not wait
/// for it. Ends when `stop` holds. Throws Error(input) for a file or a room that cannot be used, Error(usage)
/// for people who are not in the recording.
std::vector<ReplayedPerson> replay_session(const ReplayOptions& options, const std::function<bool()>& stop,
                                           const std::function<void(const std::string& words)>& say);

}  // namespace telemime
