// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "telemime/likelihood/cues/contour.h"
#include "telemime/likelihood/cues/reductions.h"
#include "telemime/likelihood/cues/region.h"

namespace telemime {

/// A cue: a name, the reduction that it needs, and its cost of the counts (0 is a perfect match).
struct Cue {
  std::string_view name;
  std::string_view unit;
  Reduction needs;
  double (*cost)(const Reductions& reductions, double distance_cap);
};

/// Every cue, one line each.
inline constexpr std::array<Cue, 2> kCues = {{
    {"region", "ratio", Reduction::overlap,
     [](const Reductions& r, double) { return non_overlapping_ratio(r); }},
    {"contour", "px", Reduction::contour, mean_edge_distance},
}};

}  // namespace telemime
