// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "meeting/protocol/recording_reader.h"
#include "meeting/transport/login.h"
#include "meeting/transport/replay_participant.h"

namespace telemime::meeting {

/// Participants that are replayed at once, at most.
inline constexpr std::size_t kMostReplayed = 100;

/// Factors of the playback speed.
inline constexpr double kSlowestReplay = 0.1;
inline constexpr double kFastestReplay = 100.0;

struct ReplayOptions {
  std::filesystem::path file;
  std::string to;              ///< a room's link, or a broker's URL
  std::filesystem::path ca;    ///< as LinkLogin::ca
  double speed = 1.0;          ///< 0.1 to 100
  bool loop = false;           ///< from the beginning again, until it is stopped
  std::set<std::string> only;  ///< participants' or people's names; everybody when empty
  MeetingLogin::Enter enter = log_in_by_link;
};

/// What became of a participant of the recording.
struct ReplayedParticipant {
  std::string recorded;     ///< whose messages these were
  std::string participant;  ///< who says them now
  std::set<std::string> names;
  ReplayParticipant::Status status;
};

/// Plays a recording into a room: each of its participants comes in as one of its own, says what was said at
/// its time, and leaves at the end. Frames that the broker cannot take in time are dropped; times do not wait
/// for it. Ends when `stop` holds. Throws Error(input) for a file or a room that cannot be used, Error(usage)
/// for people who are not in the recording.
std::vector<ReplayedParticipant> replay_recording(const ReplayOptions& options,
                                                  const std::function<bool()>& stop,
                                                  const std::function<void(const std::string& words)>& say);

}  // namespace telemime::meeting
