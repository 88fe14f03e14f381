// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/encoders/glb.h"

#include "telemime/outputs/gltf/motion_encoder.h"

namespace telemime {

std::unique_ptr<Encoder> make_glb_encoder() {
  return make_gltf_motion_encoder(GltfMotion::seen);
}

}  // namespace telemime
