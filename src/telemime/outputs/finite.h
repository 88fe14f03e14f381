// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/body/motion_frame.h"

namespace telemime {

/// Removes NaN and infinity from a stream of frames by repeating the last finite values.
class FiniteFrames {
 public:
  /// The frame with finite values only. A non-finite pose or joint makes the frame lost, with the last finite
  /// pose and joints; a non-finite pixel, score or time is replaced by its last finite value.
  MotionFrame operator()(const MotionFrame& frame);

 private:
  static MotionFrame blank();
  MotionFrame last_ = blank();
};

}  // namespace telemime
