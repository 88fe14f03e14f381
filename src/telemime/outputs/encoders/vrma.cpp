// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/encoders/vrma.h"

#include "telemime/outputs/gltf/motion_encoder.h"

namespace telemime {

std::unique_ptr<Encoder> make_vrma_encoder() {
  return make_gltf_motion_encoder(GltfMotion::vrma);
}

}  // namespace telemime
