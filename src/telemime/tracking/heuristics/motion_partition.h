// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/context.h"
#include "telemime/tracking/generation.h"

namespace telemime {

/// Only parts that uncovered pixels of their class since the last frame are diffused (thesis 4.4.2.2.1,
/// equations 4.15 to 4.20); when the trunk moves, everything is.
void find_moving_parts(const FilterContext& context, Generation& generation);

}  // namespace telemime
