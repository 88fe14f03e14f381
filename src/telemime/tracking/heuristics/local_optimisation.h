// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/heuristics/heuristic.h"

namespace telemime {

/// Moves families that are large enough towards the minimum near them (thesis 4.4.2.2.2): by the single
/// simplex of the thesis, every vertex of which becomes a particle, or by the block search of
/// RegistrationConfig, whose result becomes one particle with the prior of all its evaluations.
/// The block search has two starts for the heaviest parent: its prediction and its pose. In frames with
/// landmarks, the worse of the two is searched briefly (FilterConfig::second_evaluations).
void optimise_families(const FilterContext& context, Generation& generation);

}  // namespace telemime
