// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <string_view>

#include "telemime/outputs/encoder.h"

namespace telemime {

/// motion.bap: the 20 angles as body animation parameters of MPEG-4, for the player that the profile names
/// (bap/profile.h). Throws Error(usage) for an unknown profile.
std::unique_ptr<Encoder> make_bap_encoder(std::string_view profile);

}  // namespace telemime
