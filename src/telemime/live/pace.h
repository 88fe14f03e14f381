// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime {

/// How much of the configured search a live run can afford, so that it keeps up with the camera and leaves
/// time for what shows the result. Fed with times; deterministic in them.
class Pace {
 public:
  /// Share of the configuration's evaluations for the next frame: 1 where there is time, never under 0.25.
  double effort() const { return effort_; }

  /// A frame was searched with effort(): `search_ms` is what that took, `interval_ms` the time since the
  /// camera's frame before (both above 0; else nothing is learned).
  void searched(double search_ms, double interval_ms);

 private:
  double effort_ = 1.0;
  double full_ms_ = 0.0;      // of a search with all evaluations, smoothed; 0: not known
  double interval_ms_ = 0.0;  // between the camera's frames, smoothed; 0: not known
};

}  // namespace telemime
