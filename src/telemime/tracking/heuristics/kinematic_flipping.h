// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/heuristics/heuristic.h"

namespace telemime {

/// Adds the other poses with the same elbows and wrists in the image (thesis 4.4.2.2.3) for the best
/// particles of FilterConfig::flip_candidates families. They replace the lightest particles.
void flip_best(const FilterContext& context, Generation& generation);

}  // namespace telemime
