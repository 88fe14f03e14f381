// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "telemime/outputs/encoder.h"

namespace telemime {

enum class GltfMotion {
  seen,  ///< with a mannequin that shows the motion
  vrma,  ///< bones only, named for VRM (VRMC_vrm_animation 1.0)
};

/// The skeleton of humanoid.h in its T-pose and an animation of it, as a binary glTF file.
///
/// A track of glTF must be contiguous, so keys cannot be appended one by one. Until `end`, all keys are
/// appended again whenever their number has doubled, and the patch makes the head of the file refer to them.
/// The file of a run that is killed is therefore valid and has at least half of the motion. Unused parts make
/// the file two to three times as large; the keys stay in memory, 230 bytes each.
std::unique_ptr<Encoder> make_gltf_motion_encoder(GltfMotion kind);

}  // namespace telemime
