// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "telemime/body/body.h"
#include "telemime/body/motion_frame.h"
#include "telemime/core/camera.h"

namespace telemime {

/// The longest gap between two frames that is filled, s.
inline constexpr double kLongestBridge = 10.0;

/// Makes frames that came when they came into frames at a constant rate, as files of motion need them:
/// between two tracked frames at most half a second apart the joints turn evenly; in longer gaps the person
/// is lost. A gap of more than kLongestBridge is not filled: what follows it belongs into another file.
class Resampler {
 public:
  /// `fps` > 0; `camera` is that of MotionFrame::pixels.
  Resampler(const Body& body, const Camera& camera, double fps) : body_(body), camera_(camera), fps_(fps) {}

  /// How long before this frame the last one was, s; 0 of the first one.
  double gap_before(const MotionFrame& frame) const { return last_ ? frame.time - last_->time : 0.0; }

  /// Frames in the order of time. Returns those of the constant rate up to it, frame and time from 0 at the
  /// first one. Throws Error(usage) for one after a gap that is not filled.
  std::vector<MotionFrame> push(const MotionFrame& frame);

 private:
  MotionFrame between(const MotionFrame& a, const MotionFrame& b, double time) const;

  Body body_;
  Camera camera_;
  double fps_;
  std::optional<MotionFrame> last_;
  double start_ = 0.0;
  std::int64_t count_ = 0;  ///< handed out
};

}  // namespace telemime
