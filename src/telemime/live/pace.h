// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/core/settings.h"

namespace telemime {

/// How much of the configured search a live run can afford, so that it keeps up with the camera and leaves
/// time to show the result. A deterministic function of the times that it is given.
class Pace {
 public:
  /// Share of the configured evaluations for the next frame: 1 if there is time, at least 0.25.
  double effort() const { return effort_; }

  /// Reports a frame that was searched with effort(): `search_ms` is the time that it took, `interval_ms` the
  /// time since the camera's previous frame (both above 0; otherwise ignored).
  void searched(double search_ms, double interval_ms);

 private:
  double effort_ = 1.0;
  double full_ms_ = 0.0;      // of a search with all evaluations, smoothed; 0: not known
  double interval_ms_ = 0.0;  // between the camera's frames, smoothed; 0: not known
};

/// Whether a run with these settings may search less when time is short: none of them says how much to
/// search.
bool keeps_pace(const SettingValues& given);

}  // namespace telemime
