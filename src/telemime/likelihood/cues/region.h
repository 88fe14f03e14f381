// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

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

/// How far labels can be trusted where the poses of the last frames leave this much of F on average, 0 to 1.
/// Labels that no pose explains are wrong, or the clothes have another shape than the model: they pull arms
/// to wrong places. The trust is full up to 0.15, which correct labels stay below, and a sixteenth at twice
/// that.
inline double label_reliability(double residual) {
  constexpr double kUsual = 0.15;
  const double more = std::max(1.0, residual / kUsual);
  return 1.0 / (more * more * more * more);
}

inline constexpr Cue kRegionCue = {
    .name = "regions",
    .what = "F: share of the skin, clothes and head pixels in which image and model differ",
    .needs = Reduction::overlap,
    .region_step = 1.0,
    .edge_step = 1.0,
    .sigma_key = "sigma_F",
    .reliability =
        [](const PreparedFrame& frame) { return frame.has_colours ? frame.label_reliability : 0.0; },
    .cost = [](const CueInput& input) { return non_overlapping_ratio(input.reductions); },
};

}  // namespace telemime
