// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/context.h"
#include "telemime/tracking/generation.h"

namespace telemime {

/// The heaviest parent with its trunk turned about the neck: upright and to where somebody who walks would
/// face; the same as far away as its lower end when it leans far, since a lean and another distance look
/// alike; and in every other frame, by chance, turned by a random angle. The arms turn with it or stay where
/// they are seen, whichever fits better; then comes a search, a longer one for trunks that had turned or
/// leaned far.
/// Regions and contours hardly say which way a trunk turns, so a turn is seldom found from a pose that has
/// missed its beginning.
void search_heading(const FilterContext& context, Generation& generation);

}  // namespace telemime
