// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/end_effector.h"

namespace telemime {

void use_end_effector_space(const FilterContext& /*context*/, Generation& generation) {
  generation.end_effector = true;
}

}  // namespace telemime
