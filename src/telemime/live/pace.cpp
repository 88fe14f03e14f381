// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/pace.h"

#include <algorithm>
#include <cmath>

namespace telemime {
namespace {

// Of the time between two frames: the search is on all cores, and the image side, the page and whatever shows
// the avatar need them, too.
constexpr double kShare = 0.3;
constexpr double kLeast = 0.25;
constexpr double kRate = 0.1;   // of the smoothed time, a frame
constexpr double kStep = 0.05;  // of the effort: smaller changes are not worth a change

}  // namespace

void Pace::searched(double search_ms, double interval_ms) {
  if (!(search_ms > 0.0 && interval_ms > 0.0 && std::isfinite(search_ms) && std::isfinite(interval_ms))) {
    return;
  }
  // One frame that waited for the processor must not count for many.
  const double full = full_ms_ > 0.0 ? std::min(search_ms / effort_, 3.0 * full_ms_) : search_ms / effort_;
  full_ms_ = full_ms_ > 0.0 ? full_ms_ + kRate * (full - full_ms_) : full;
  const double affordable = std::clamp(kShare * interval_ms / full_ms_, kLeast, 1.0);
  if (std::abs(affordable - effort_) >= kStep || affordable == 1.0 || affordable == kLeast) {
    effort_ = affordable;
  }
}

}  // namespace telemime
