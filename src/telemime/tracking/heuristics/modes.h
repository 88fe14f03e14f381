// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/context.h"
#include "telemime/tracking/generation.h"

namespace telemime {

/// Parents of one mode - elbows and wrists within FilterConfig::mode_radius of the best one's - become one,
/// with their weight; the FilterConfig::modes heaviest ones stay. Weights are raised to FilterConfig::memory
/// first.
void merge_modes(const FilterContext& context, Generation& generation);

}  // namespace telemime
