// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <deque>
#include <memory>
#include <optional>

#include "telemime/tracker/smoother.h"

namespace telemime {

/// Smooths with what comes after a frame as well as with what came before: the filter runs forward in time,
/// and then backward over its own result. What lags one way runs ahead the other way, so the lag goes, and
/// the filter acts twice. Frames come out SmoothingOptions::look_ahead frames late. With look_ahead 0 it is
/// the plain filter.
class TwoWaySmoother {
 public:
  /// Throws Error(config) when a name or a number is not usable.
  TwoWaySmoother(const SmoothingOptions& options, const Body& body, const Camera& camera);

  /// Frames in the order of their time.
  void push(const MotionFrame& frame);
  /// The next frame with all its future, in the order in which they came; nothing when it must still wait.
  std::optional<MotionFrame> next();
  /// No frame comes any more: next() gives the rest.
  void finish() { finished_ = true; }

 private:
  SmoothingOptions options_;
  Body body_;
  Camera camera_;
  std::unique_ptr<Smoother> forward_;
  std::deque<MotionFrame> waiting_;  // smoothed forward in time
  bool finished_ = false;
};

}  // namespace telemime
