// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "meeting/transport/login.h"
#include "meeting/transport/replay_participant.h"

namespace telemime::meeting {

/// Maximum number of participants of a replay.
inline constexpr std::size_t kMostReplayed = 100;
/// Limits of the playback speed.
inline constexpr double kSlowestReplay = 0.1;
inline constexpr double kFastestReplay = 100.0;

struct ReplayOptions {
  std::filesystem::path file;
  std::string to;              ///< link of a meeting, or URL of a broker
  std::filesystem::path ca;    ///< as LinkLogin::ca
  double speed = 1.0;          ///< kSlowestReplay to kFastestReplay
  bool loop = false;           ///< start again at the end, until it is stopped
  std::set<std::string> only;  ///< participants or their names; empty: everyone
  MeetingLogin::LogIn log_in = log_in_by_link;
};

/// The result for one participant of the recording.
struct ReplayedParticipant {
  std::string recorded;     ///< id in the recording
  std::string participant;  ///< id in the meeting
  std::set<std::string> names;
  ReplayParticipant::Status status;
};

/// Replays a recording to a meeting: each of its participants joins, publishes each message at its time and
/// leaves at the end. Frames that the broker does not accept in time are dropped, so the times never wait for
/// it. Ends when `stop` returns true. Throws Error(input) for a file or a meeting that cannot be used, and
/// Error(usage) for names that are not in the recording.
std::vector<ReplayedParticipant> replay_recording(const ReplayOptions& options,
                                                  const std::function<bool()>& stop,
                                                  const std::function<void(const std::string& text)>& report);

}  // namespace telemime::meeting
