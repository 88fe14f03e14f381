// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "telemime/body/motion_frame.h"
#include "telemime/outputs/fingers.h"

namespace telemime {

/// The bones of a VRM humanoid that this project uses; the legs are not tracked and do not move.
enum class HumanBone : std::size_t {
  hips,
  spine,
  chest,
  neck,
  head,
  l_shoulder,
  l_upper_arm,
  l_lower_arm,
  l_hand,
  r_shoulder,
  r_upper_arm,
  r_lower_arm,
  r_hand,
  l_upper_leg,
  l_lower_leg,
  l_foot,
  r_upper_leg,
  r_lower_leg,
  r_foot,
};
inline constexpr std::size_t kHumanBoneCount = 19;
/// Their names in VRM 1.0.
inline constexpr std::array<std::string_view, kHumanBoneCount> kHumanBoneNames = {
    "hips",          "spine",         "chest",         "neck",         "head",
    "leftShoulder",  "leftUpperArm",  "leftLowerArm",  "leftHand",     "rightShoulder",
    "rightUpperArm", "rightLowerArm", "rightHand",     "leftUpperLeg", "leftLowerLeg",
    "leftFoot",      "rightUpperLeg", "rightLowerLeg", "rightFoot"};

/// The parent of each bone, by index; the hips have -1.
inline constexpr std::array<int, kHumanBoneCount> kHumanBoneParent = {-1, 0,  1,  2, 3,  2,  5, 6,  7, 2,
                                                                      9,  10, 11, 0, 13, 14, 0, 16, 17};

/// The bone on which a finger bone is.
constexpr HumanBone hand_of_finger_bone(std::size_t finger_bone) {
  return side_of_finger_bone(finger_bone) == Side::left ? HumanBone::l_hand : HumanBone::r_hand;
}

/// A body in the T-pose of VRM 1.0: facing +z, x to its own left, y up, soles at y = 0, arms along x, palms
/// down; m. At rest all bones have the axes of the world.
struct HumanoidSkeleton {
  std::array<Eigen::Vector3d, kHumanBoneCount> position;  ///< of each bone's joint, in the world
  std::array<Eigen::Vector3d, kHumanBoneCount> end;       ///< where bones without a child end; others: child
  std::optional<FingerSkeleton> fingers;                  ///< on the hands
  Eigen::Vector3d offset(HumanBone bone) const;           ///< from the parent's joint; of the hips: position
};

/// A pose of that skeleton: the normalised pose of VRM.
struct HumanoidMotion {
  Eigen::Vector3d hips;                                      ///< m, in the frame of the skeleton's world
  std::array<Eigen::Quaterniond, kHumanBoneCount> rotation;  ///< parent from bone, w >= 0; identity at rest
  std::optional<FingerRotations> fingers;                    ///< the same; empty where hands are not tracked
  const Eigen::Quaterniond& operator[](HumanBone b) const { return rotation[static_cast<std::size_t>(b)]; }
};

/// With the fingers of average hands.
HumanoidSkeleton humanoid_skeleton(const Body& body);

/// The pose of humanoid_skeleton(body). The hips take the trunk's heading, the spine the rest of its
/// rotation; half of the wrist's twist is in the forearm. A single clavicle cannot reproduce the motion of
/// the shoulder (body.h) exactly: hands are within 10 mm. `origin` is the position of the root (m, camera
/// frame) at which the hips are above those of the skeleton.
HumanoidMotion humanoid_motion(const Body& body, const Pose& pose, const Eigen::Vector3d& origin);

/// Rotations of the neck in the chest and of the head in the neck.
struct NeckAndHead {
  Eigen::Quaterniond neck, head;
};

/// Neck and head, each turned by half to how the face holds the head, as far as the face is seen (its
/// confidence); `unseen` where it is not. The world is that of the skeleton.
NeckAndHead neck_and_head(const FaceMotion& face, const Eigen::Quaterniond& world_from_chest,
                          const NeckAndHead& unseen);

/// The same for a motion.
void turn_head(const FaceMotion& face, HumanoidMotion& motion);

/// The same of a frame, with its hands.
HumanoidMotion humanoid_motion(const Body& body, const MotionFrame& frame, const Eigen::Vector3d& origin);

/// The joints of the bones by forward kinematics, m.
std::array<Eigen::Vector3d, kHumanBoneCount> humanoid_joints(const HumanoidSkeleton& skeleton,
                                                             const HumanoidMotion& motion);

}  // namespace telemime
