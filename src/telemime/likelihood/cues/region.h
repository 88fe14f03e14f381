// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/likelihood/cues/cue.h"

namespace telemime {

/// Non-overlapping ratio F in [0, 1] (thesis equation 2.5, mean over the classes): 0 when image and model
/// agree in every class, 1 when nothing overlaps. A class that is empty in both counts 0.
inline double non_overlapping_ratio(const Reductions& r) {
  double sum = 0.0;
  for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
    const int either = r.observed[c] + r.model[c] - r.both[c];
    if (either > 0) {
      sum += static_cast<double>(either - r.both[c]) / either;
    }
  }
  return sum / static_cast<double>(kSurfaceClassCount);
}

inline constexpr Cue kRegionCue = {
    .name = "regions",
    .what = "F: share of the skin, clothes and head pixels in which image and model differ",
    .needs = Reduction::overlap,
    .region_step = 1.0,
    .edge_step = 1.0,
    .sigma_key = "sigma_F",
    .reliability = [](const PreparedFrame& frame) { return frame.has_colours ? 1.0 : 0.0; },
    .cost = [](const CueInput& input) { return non_overlapping_ratio(input.reductions); },
};

}  // namespace telemime
