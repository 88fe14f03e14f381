// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/pace.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace telemime {
namespace {

// Of the time between two frames: the search is on all cores, and the image side, the page and whatever shows
// the avatar need them, too.
constexpr double kShare = 0.3;
constexpr double kLeast = 0.25;
constexpr double kRate = 0.1;   // of the smoothed time, a frame
constexpr double kStep = 0.05;  // of the effort: smaller changes are not worth a change

// One frame that waited for the processor, or for the camera, must not count for many.
double smoothed(double before, double now) {
  return before > 0.0 ? before + kRate * (std::min(now, 3.0 * before) - before) : now;
}

}  // namespace

void Pace::searched(double search_ms, double interval_ms) {
  if (!(search_ms > 0.0 && interval_ms > 0.0 && std::isfinite(search_ms) && std::isfinite(interval_ms))) {
    return;
  }
  full_ms_ = smoothed(full_ms_, search_ms / effort_);
  interval_ms_ = smoothed(interval_ms_, interval_ms);
  const double affordable = std::clamp(kShare * interval_ms_ / full_ms_, kLeast, 1.0);
  if (std::abs(affordable - effort_) >= kStep || affordable == 1.0 || affordable == kLeast) {
    effort_ = affordable;
  }
}

bool keeps_pace(const SettingValues& given) {
  return !given.contains("particles") && !given.contains("budget") &&
         !given.contains("registration.iterations");
}

}  // namespace telemime
