// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/context.h"
#include "telemime/tracking/generation.h"

namespace telemime {

/// The other poses with the same elbows and wrists in the image (thesis 4.4.2.2.3), of the best particles of
/// the FilterConfig::flip_candidates heaviest families. They take the place of the lightest particles.
void flip_best(const FilterContext& context, Generation& generation);

}  // namespace telemime
