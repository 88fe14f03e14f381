// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/body/motion_frame.h"

namespace telemime {

/// What every output does to a stream of frames first: a lost frame repeats the last known body, and no value
/// is NaN or infinite.
class CleanFrames {
 public:
  /// The frame with finite values only. A non-finite pose or joint makes the frame lost. A lost frame has the
  /// pose, joints, pixels and hands of the last tracked one, or its own before any was tracked. A non-finite
  /// pixel, score or time is replaced by its last finite value.
  MotionFrame operator()(const MotionFrame& frame);

 private:
  static MotionFrame blank();
  MotionFrame last_ = blank();
  bool tracked_ = false;  ///< in an earlier frame
};

}  // namespace telemime
