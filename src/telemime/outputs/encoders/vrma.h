// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "telemime/outputs/encoder.h"

namespace telemime {

/// motion.vrma: VRM animation 1.0 for any VRM avatar (gltf/motion_encoder.h).
std::unique_ptr<Encoder> make_vrma_encoder();

}  // namespace telemime
