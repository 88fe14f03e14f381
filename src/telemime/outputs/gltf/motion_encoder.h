// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "telemime/outputs/encoder.h"

namespace telemime {

enum class GltfMotion {
  seen,  ///< with a mannequin to see the motion by
  vrma,  ///< bones only, named for VRM (VRMC_vrm_animation 1.0)
};

/// The skeleton of humanoid.h in its T-pose and an animation of it, as a binary glTF file.
///
/// A track of glTF lies in one piece, so keys cannot be appended one by one. Until `end`, all keys so far are
/// appended anew whenever their number has doubled, and the patch points the head of the file at them: what
/// a run leaves that is killed is valid and has at least half of the motion. The pieces that are no longer
/// pointed at make the file two to three times as big; the keys stay in memory, 230 bytes each.
std::unique_ptr<Encoder> make_gltf_motion_encoder(GltfMotion kind);

}  // namespace telemime
