// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

namespace telemime {

/// Where a live run stands.
enum class LivePhase {
  opening,     ///< the camera or the tracker is being made ready; no picture was looked at yet
  empty_room,  ///< waits for the user to step out of the picture
  background,  ///< learns the scene
  person,      ///< waits for a person who can be calibrated
  tracking,
  lost,
  stopped,  ///< the camera gives no pictures now
  ended,    ///< there will be no more frames
};

/// As docs/live-protocol.md names it.
std::string_view to_string(LivePhase phase);

}  // namespace telemime
