// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/likelihood/cues/cue.h"

namespace telemime {

/// Mean edge distance D_C in pixels of the working image (thesis equation 3.13): the mean of the capped
/// distance map over the visible occluding contour. A model without a visible contour scores `cap`.
inline double mean_edge_distance(const Reductions& r, double cap) {
  return r.contour_points > 0 ? r.contour_sum / r.contour_points : cap;
}

inline constexpr Cue kContourCue = {
    .name = "contours",
    .what = "D_C: mean distance from the model's contour to the nearest edge in the image",
    .unit = CueUnit::pixels,
    .needs = Reduction::contour,
    .region_step = 0.0,
    .edge_step = 0.15,
    .scale = 0.02,
    .sigma_key = "sigma_D_share_of_width",
    .cost = [](const CueInput& in) { return mean_edge_distance(in.reductions, in.frame.distance_cap); },
};

}  // namespace telemime
