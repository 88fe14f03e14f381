// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/outputs/gltf/document.h"
#include "telemime/outputs/humanoid.h"

namespace telemime {

/// Adds a mesh of one rounded piece along every bone, each following its bone alone: something to see the
/// motion by, and what makes Blender import the bones as an armature. Returns the mesh's index.
std::size_t add_mannequin(GltfDocument& document, const HumanoidSkeleton& skeleton, double stature);

}  // namespace telemime
