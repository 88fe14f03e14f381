// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/heuristics/heuristic.h"

namespace telemime {

/// Adds the likeliest particle with each pair of the best left arms and the best right arms of all particles.
/// Given the trunk, one arm hardly depends on the other, so that the best of each need not have met in one
/// particle yet: the crossover of Deutscher & Reid, Articulated Body Motion Capture by Stochastic Search,
/// IJCV 61(2), 2005. They replace the lightest particles. Only in frames
/// with landmarks.
void exchange_best_arms(const FilterContext& context, Generation& generation);

}  // namespace telemime
