// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "telemime/body/body.h"
#include "telemime/body/face_motion.h"
#include "telemime/outputs/fingers.h"

namespace telemime {

/// Bones of motion.bvh in the order of the file. The legs are not tracked and stand still under the hips.
enum class BvhBone : std::size_t {
  hips,
  spine,
  spine1,
  neck,
  head,
  l_collar,
  l_blade,
  l_arm,
  l_forearm,
  l_hand,
  r_collar,
  r_blade,
  r_arm,
  r_forearm,
  r_hand,
  l_thigh,
  l_shank,
  l_foot,
  r_thigh,
  r_shank,
  r_foot,
};
inline constexpr std::size_t kBvhBoneCount = 21;

/// One joint of a BVH hierarchy, in cm. At rest all joint frames are parallel.
struct BvhJoint {
  std::string name;
  int parent = -1;  ///< index of the parent, smaller than the own; -1 for the root
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< from the parent
  std::optional<Eigen::Vector3d> end_site;           ///< end of a joint without children
};

/// The skeleton of a body in a T-pose: arms along x, palms down, y up, facing +z, cm. Every joint turns by
/// Zrotation Xrotation Yrotation; only the hips translate. The fingers, if any, come after the bones of
/// BvhBone.
std::vector<BvhJoint> bvh_skeleton(const Body& body,
                                   const std::optional<FingerSkeleton>& fingers = std::nullopt);

/// What the bones of bvh_skeleton(body) do in a pose.
struct BvhMotion {
  Eigen::Vector3d hips;  ///< cm; x right, y up, z toward the camera from it
  std::array<Eigen::Matrix3d, kBvhBoneCount> parent_from_bone;  ///< rotations, identity in the T-pose
};

/// The hips take the heading of the trunk, the spine the rest of its rotation. A clavicle and a shoulder
/// blade move the shoulder centre, which in this body model moves with the upper arm (body.h), to its exact
/// place.
BvhMotion bvh_motion(const Body& body, const Pose& pose);

/// Turns neck and head to how the face holds the head (neck_and_head).
void turn_head(const FaceMotion& face, BvhMotion& motion);

}  // namespace telemime
