// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "telemime/outputs/encoder.h"

namespace telemime {

/// motion.glb: glTF 2.0 animation of a mannequin, metres, y up (gltf/motion_encoder.h).
std::unique_ptr<Encoder> make_glb_encoder();

}  // namespace telemime
