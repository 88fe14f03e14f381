// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/likelihood/cues/cue.h"

namespace telemime {

/// Root mean square over all landmarks, in standard deviations, of the errors of those that a network sees.
double landmark_cost(const CueInput& input);

inline constexpr Cue kLandmarkCue = {
    .name = "landmarks",
    .what = "Distance of the model's joints from where a network sees them, in standard deviations",
    .needs_landmarks = true,
    .region_step = 0.05,
    .edge_step = 0.05,
    .sigma_key = "sigma_landmarks",
    .reliability = [](const PreparedFrame& frame) { return frame.landmarks ? 1.0 : 0.0; },
    .cost = landmark_cost,
};

/// Root mean square over all bones, in standard deviations, of the errors of their slopes in depth.
double bone_cost(const CueInput& input);

inline constexpr Cue kBoneCue = {
    .name = "bones",
    .what = "Difference of the bones' slopes in depth from those that a network sees",
    .needs_landmarks = true,
    .region_step = 0.01,
    .edge_step = 0.01,
    .sigma_key = "sigma_bones",
    .reliability = [](const PreparedFrame& frame) { return frame.landmarks ? 1.0 : 0.0; },
    .cost = bone_cost,
};

}  // namespace telemime
