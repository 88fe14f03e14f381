// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>

#include "telemime/outputs/gltf/document.h"
#include "telemime/outputs/humanoid.h"
#include "telemime/outputs/vrm_expressions.h"

namespace telemime {

/// The node of a finger bone, after those of HumanBone.
constexpr std::size_t finger_node(std::size_t bone) {
  return kHumanBoneCount + bone;
}

/// Adds the bones as nodes 0 to 18 of an empty document, in the order of HumanBone, then the fingers that the
/// skeleton has, and the hips to the scene.
void add_humanoid(GltfDocument& document, const HumanoidSkeleton& skeleton);

/// Places the finger bones of such a document where those of other hands are.
void set_fingers(GltfDocument& document, const FingerSkeleton& fingers);

/// Adds a skin whose joint b is node b; returns its index.
std::size_t add_humanoid_skin(GltfDocument& document, const HumanoidSkeleton& skeleton);

/// Adds a mesh as a node of the scene that this skin moves; returns the node's index.
std::size_t add_skinned_mesh(GltfDocument& document, const char* name, std::size_t mesh, std::size_t skin);

/// Adds a mesh with one rounded piece along every bone, which follows only that bone. It shows the motion and
/// makes Blender import the bones as an armature. Returns the mesh's index.
std::size_t add_mannequin(GltfDocument& document, const HumanoidSkeleton& skeleton, double stature);

/// The expressions of VRM that an animation has: all but those of the gaze.
inline constexpr std::size_t kAnimatedExpressionCount = 13;

/// Adds a node for each of these expressions, then one for the gaze, to the scene; returns the first.
std::size_t add_face_nodes(GltfDocument& document);

/// The expressions and the gaze of VRMC_vrm_animation, given the first of these nodes.
nlohmann::ordered_json animated_expressions(std::size_t first_node);
nlohmann::ordered_json animated_look_at(std::size_t first_node);

/// The map from names of bones to nodes, as in VRMC_vrm and VRMC_vrm_animation.
nlohmann::ordered_json human_bones(const HumanoidSkeleton& skeleton);

}  // namespace telemime
