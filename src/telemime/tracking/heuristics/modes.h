// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/context.h"
#include "telemime/tracking/generation.h"

namespace telemime {

/// Parents of one mode - elbows and wrists within FilterConfig::mode_radius of the best one's - become the
/// likeliest of them, with their summed weight raised to FilterConfig::memory; the FilterConfig::modes
/// heaviest ones stay.
void merge_modes(const FilterContext& context, Generation& generation);

}  // namespace telemime
