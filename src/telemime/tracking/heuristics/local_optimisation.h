// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/context.h"
#include "telemime/tracking/generation.h"

namespace telemime {

/// Families large enough for a simplex are led toward the minimum near them (thesis 4.4.2.2.2): the single
/// simplex of the thesis, every vertex of which becomes a particle, or the block search of
/// RegistrationConfig, whose result becomes one particle with the share of all that it cost.
void optimise_families(const FilterContext& context, Generation& generation);

}  // namespace telemime
