// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "telemime/outputs/encoder.h"

namespace telemime {

/// motion.bvh: Biovision hierarchy, y up, facing +z, centimetres, T-pose at rest (bvh/skeleton.h).
std::unique_ptr<Encoder> make_bvh_encoder();

}  // namespace telemime
