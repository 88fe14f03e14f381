// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <functional>
#include <optional>

#include "telemime/body/body.h"
#include "telemime/body/motion_frame.h"
#include "telemime/core/camera.h"

namespace telemime {

/// The longest time between two frames across which motion at this rate is interpolated, s.
inline double longest_gap(double fps) {
  return std::max(0.5, 2.5 / fps);
}

/// Resamples motion frames to a constant rate, as motion files require. Between two tracked frames at most
/// longest_gap() apart the joint rotations are interpolated; in longer gaps the person is lost.
class Resampler {
 public:
  /// `fps` > 0; `camera` is that of MotionFrame::pixels.
  Resampler(const Body& body, const Camera& camera, double fps)
      : body_(body), camera_(camera), fps_(fps), longest_gap_(longest_gap(fps)), slack_(0.03 / fps) {}

  /// The person of the frames that follow.
  void set_body(const Body& body) { body_ = body; }

  /// Time since the previous frame, s; 0 for the first frame.
  double gap_before(const MotionFrame& frame) const { return last_ ? frame.time - last_->time : 0.0; }

  /// Adds a frame; times must increase. Passes on the resampled frames up to its time one by one (a pause may
  /// have very many); their number and time start at 0.
  void push(const MotionFrame& frame, const std::function<void(const MotionFrame&)>& take);

 private:
  MotionFrame between(const MotionFrame& a, const MotionFrame& b, double time) const;

  Body body_;
  Camera camera_;
  double fps_;
  double longest_gap_;
  double slack_;  ///< s; time stamps are rounded
  std::optional<MotionFrame> last_;
  double start_ = 0.0;
  std::int64_t count_ = 0;  ///< number of frames returned
};

}  // namespace telemime
