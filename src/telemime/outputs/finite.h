// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/body/motion_frame.h"

namespace telemime {

/// Keeps NaN and infinity out of the files: remembers the last finite values of a stream of frames.
class FiniteFrames {
 public:
  /// The frame with everything finite. A pose or joint that is not makes the whole frame lost, with the last
  /// good pose and joints; a pixel, score or time that is not takes its last good value alone.
  MotionFrame operator()(const MotionFrame& frame);

 private:
  static MotionFrame blank();
  MotionFrame last_ = blank();
};

}  // namespace telemime
