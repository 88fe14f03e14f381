// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "telemime/body/body.h"
#include "telemime/body/motion_frame.h"
#include "telemime/core/camera.h"

namespace telemime {

/// The longest gap between two frames that is filled, in s.
inline constexpr double kLongestBridge = 10.0;

/// Resamples motion frames to a constant rate, as motion files require. Between two tracked frames at most
/// 0.5 s apart the joint rotations are interpolated; in longer gaps the person is lost. A gap of more than
/// kLongestBridge is not filled: start a new file after it.
class Resampler {
 public:
  /// `fps` > 0; `camera` is that of MotionFrame::pixels.
  Resampler(const Body& body, const Camera& camera, double fps) : body_(body), camera_(camera), fps_(fps) {}

  /// Time since the previous frame, s; 0 for the first frame.
  double gap_before(const MotionFrame& frame) const { return last_ ? frame.time - last_->time : 0.0; }

  /// Adds a frame; times must increase. Returns the resampled frames up to its time, whose number and time
  /// start at 0. Throws Error(usage) after a gap longer than kLongestBridge.
  std::vector<MotionFrame> push(const MotionFrame& frame);

 private:
  MotionFrame between(const MotionFrame& a, const MotionFrame& b, double time) const;

  Body body_;
  Camera camera_;
  double fps_;
  std::optional<MotionFrame> last_;
  double start_ = 0.0;
  std::int64_t count_ = 0;  ///< number of frames returned
};

}  // namespace telemime
