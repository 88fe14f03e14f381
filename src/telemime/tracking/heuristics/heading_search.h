// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/heuristics/heuristic.h"

namespace telemime {

/// Adds the heaviest parent with its trunk turned about the neck: upright and towards the predicted heading;
/// if it leans far, also at the distance of its lower end, since a lean and another distance look alike; and
/// with probability 1/2 by a random angle. The arms turn with the trunk or stay where they are in the image,
/// whichever fits better; then the pose is searched, longer for trunks that were turned or leaning far.
/// Regions and contours hardly show a turn of the trunk, so that a local search seldom finds one whose
/// beginning it missed.
void search_heading(const FilterContext& context, Generation& generation);

}  // namespace telemime
