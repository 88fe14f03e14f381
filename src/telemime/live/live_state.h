// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "telemime/live/live_statistics.h"

namespace telemime {

/// Severity of a message for the user: `info` is optional reading, `warning` means that results are worse
/// than they could be, `error` that something requested does not work.
enum class MessageLevel { info, warning, error };

/// Where a live run stands.
enum class LivePhase {
  opening,     ///< the camera or the tracker is being made ready; no picture was looked at yet
  empty_room,  ///< waits for the user to step out of the picture
  background,  ///< learns the scene
  person,      ///< waits for a person who can be calibrated
  tracking,
  lost,
  stopped,  ///< the camera delivers no images now
  ended,    ///< there will be no more frames
};

/// As long as there is no session yet: `opening`.
struct LiveState {
  LivePhase phase = LivePhase::opening;
  std::string words;  ///< for the user: why nobody is tracked, what is waited for; may be empty
  LiveRates rates;
  /// In the phase `background`: the user said that the room is empty. Otherwise the background is learned
  /// around the person.
  bool room_empty = false;
  /// Warnings of LiveHooks::message that still apply, about the camera and the person.
  std::vector<std::string> warnings;
};

}  // namespace telemime
