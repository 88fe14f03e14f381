// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "telemime/streaming/person_motion.h"

namespace telemime {

/// The messages `body` and `pose` of docs/live-protocol.md, JSON without line breaks, for one person. Numbers
/// that are not finite are replaced as in outputs/clean_frames.h.
class PoseMessages {
 public:
  /// The origin of the scale is read from header.extra["scale_from"], if present.
  explicit PoseMessages(const StreamHeader& header);

  /// The person: their skeleton in its T-pose.
  std::string body() const;
  /// One frame, in the order of the stream. `stamp` is ms of the program's monotonic clock.
  std::string pose(const MotionFrame& frame, double stamp);
  /// Skips the message of a frame: later messages are the same as if it had been sent.
  void pass(const MotionFrame& frame) { motion_(motion_.clean(frame)); }

 private:
  PersonMotion motion_;
  std::string scale_from_;
};

}  // namespace telemime
