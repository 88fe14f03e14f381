// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/context.h"
#include "telemime/tracking/generation.h"

namespace telemime {

/// The heaviest parent with its trunk turned about the neck, arms and all: upright and to where somebody who
/// walks would face, and in every other frame, by chance, turned by a random angle; each followed by a short
/// search. Regions and contours hardly say which way a trunk turns, so a turn is seldom found from a pose
/// that has missed its beginning.
void turn_trunk(const FilterContext& context, Generation& generation);

}  // namespace telemime
