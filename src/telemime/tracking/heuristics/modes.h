// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/heuristics/heuristic.h"

namespace telemime {

/// Replaces the parents of each mode (elbows and wrists within FilterConfig::mode_radius of those of its
/// best) by the likeliest of them, with the sum of their weights raised to the power FilterConfig::memory.
/// Keeps the FilterConfig::modes heaviest modes.
void merge_modes(const FilterContext& context, Generation& generation);

}  // namespace telemime
