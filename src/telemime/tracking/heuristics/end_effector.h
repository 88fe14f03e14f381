// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/heuristics/heuristic.h"

namespace telemime {

/// Diffuses and searches arms by wrist position and swivel angle, with a larger range along the viewing ray
/// (thesis 4.4.2.3).
void use_end_effector_space(const FilterContext& context, Generation& generation);

}  // namespace telemime
