// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "telemime/live/live_statistics.h"

namespace telemime {

/// Severity of a message for the user: `info` is optional reading, `warning` means that results are worse
/// than they could be, `error` that something requested does not work.
enum class MessageLevel { info, warning, error };

/// The phase of a live run.
enum class LivePhase {
  opening,     ///< the camera or the tracker is starting; no image was processed yet
  empty_room,  ///< waits for the user to leave the image
  background,  ///< learns the scene
  person,      ///< waits for a person who can be calibrated
  tracking,
  lost,
  stopped,  ///< the camera delivers no images at the moment
  ended,    ///< there will be no more frames
};

/// `opening` before there is a session.
struct LiveState {
  LivePhase phase = LivePhase::opening;
  std::string words;  ///< for the user: why nobody is tracked or what the run is waiting for; may be empty
  LiveRates rates;
  /// In the phase `background`: the user said that the room is empty. Otherwise the background is learned
  /// around the person.
  bool room_empty = false;
  /// Warnings of LiveHooks::message that still apply, about the camera and the person.
  std::vector<std::string> warnings;
};

}  // namespace telemime
