// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "avatars/look.h"
#include "telemime/body/shape.h"

namespace telemime {

/// A person with these proportions as a VRM 1.0 file (binary glTF with VRMC_vrm): skinned surfaces in the
/// T-pose of humanoid.h, the expressions blink, blinkLeft and blinkRight. Both sides get the mean of the
/// shape's sides; its sleeve is not used, the look has its own. The same arguments give the same bytes.
/// Throws Error(usage) for a stature that is not between 0.5 and 2.5 m, or a scale not between 0.4 and 2.5.
std::string make_avatar(const Shape& shape, const AvatarLook& look);

}  // namespace telemime
