// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/heuristics/heuristic.h"

namespace telemime {

/// Gives each parent n_i = N w_i children, the remainder to the largest fractions; one child of the heaviest
/// parent is not diffused (thesis 4.4.2.1, equation 4.14).
void resample_by_weight(const FilterContext& context, Generation& generation);

}  // namespace telemime
