// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/context.h"
#include "telemime/tracking/generation.h"

namespace telemime {

/// Arms are diffused and searched as wrist position and swivel angle, with more room along the viewing ray
/// (thesis 4.4.2.3).
void use_end_effector_space(const FilterContext& context, Generation& generation);

}  // namespace telemime
