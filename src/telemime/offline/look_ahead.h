// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>

#include "telemime/tracker/track_frame.h"

namespace telemime {

/// The person as the first frames of a file show them.
struct FittedPerson {
  KnownStart start;
  std::int64_t frames = 0;  ///< in which the person was tracked
  /// Number of frames that the shape was fitted to; 0: too few showed the arms, and it is as one frame gave
  /// it.
  std::size_t keyframes = 0;
  double cost_before = 0.0;  ///< of refine_shape(), before and after
  double cost = 0.0;
};

/// What `look_ahead` leaves to the driver.
struct LookAhead {
  std::optional<FittedPerson> person;  ///< nothing when nobody was calibrated or the user stopped
  /// Frames with features and estimates that are still to be taken up, the earliest first.
  std::deque<FrameRecord> records;
};

/// What `look_ahead` needs of its driver.
struct LookAheadCalls {
  std::function<std::optional<Frame>()> next;  ///< the next frame; nothing at the end of the input
  /// A frame that the look-ahead is done with: nobody is in it who is tracked later. May be empty.
  std::function<void(FrameRecord)> settle = nullptr;
  /// Asked after each frame with the record of it; false stops the look-ahead. May be empty.
  std::function<bool(const FrameRecord&)> go_on = nullptr;
  int longest_side = 0;  ///< of the pictures that records keep, pixels; 0: none are kept
};

/// Calibrates on the first good frame, tracks for CalibrationConfig::look_ahead from there and fits
/// the person's shape to the most different of them (refine_shape; thesis 3.3 has one frame alone). Where a
/// person was fitted, `run` stands again where they came into the picture, knows them, and LookAhead::records
/// hold new estimates from there on. Image features are extracted once.
LookAhead look_ahead(const LookAheadCalls& calls, TrackingRun& run);

}  // namespace telemime
