// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <string>
#include <string_view>

#include "telemime/body/hand_motion.h"

namespace telemime {

/// The finger bones that all file formats, VMC and the live stream have: of the left hand, then of the right
/// one; of each finger from the base to the tip, in the order of the joints of a hand (body/hand_model.h).
inline constexpr std::size_t kFingerBoneCount = 30;
constexpr std::size_t finger_bone(Side side, std::size_t finger, std::size_t bone) {
  return 15 * static_cast<std::size_t>(side) + 3 * finger + bone;
}
constexpr Side side_of_finger_bone(std::size_t bone) {
  return bone < finger_bone(Side::right, 0, 0) ? Side::left : Side::right;
}

/// Their names in VRM 1.0.
inline constexpr std::array<std::string_view, kFingerBoneCount> kFingerBoneNames = {
    "leftThumbMetacarpal",     "leftThumbProximal",      "leftThumbDistal",         "leftIndexProximal",
    "leftIndexIntermediate",   "leftIndexDistal",        "leftMiddleProximal",      "leftMiddleIntermediate",
    "leftMiddleDistal",        "leftRingProximal",       "leftRingIntermediate",    "leftRingDistal",
    "leftLittleProximal",      "leftLittleIntermediate", "leftLittleDistal",        "rightThumbMetacarpal",
    "rightThumbProximal",      "rightThumbDistal",       "rightIndexProximal",      "rightIndexIntermediate",
    "rightIndexDistal",        "rightMiddleProximal",    "rightMiddleIntermediate", "rightMiddleDistal",
    "rightRingProximal",       "rightRingIntermediate",  "rightRingDistal",         "rightLittleProximal",
    "rightLittleIntermediate", "rightLittleDistal"};
/// The same in MotionBuilder, Mixamo and Blender's tools: LeftHandThumb1 to RightHandPinky3.
std::string motion_builder_name(std::size_t bone);

/// The flat hands of the T-pose, m: palms down, fingers along x, thumbs at 45 degrees to the front.
struct FingerSkeleton {
  std::array<Eigen::Vector3d, kFingerBoneCount> position;  ///< of each bone's joint, from the wrist
  std::array<Eigen::Vector3d, kFingerBoneCount> end;       ///< of each bone, from the wrist
  /// From the parent's joint: that of the bone before, or the wrist.
  Eigen::Vector3d offset(std::size_t bone) const;
};
/// The fingers of hands of these sizes.
FingerSkeleton finger_skeleton(const HandSizes& left, const HandSizes& right);
FingerSkeleton finger_skeleton(const HandMotions& hands);

/// Rotations of the bones in the axes of the T-pose, parent from bone, w >= 0; identity for flat hands.
using FingerRotations = std::array<Eigen::Quaterniond, kFingerBoneCount>;
FingerRotations finger_bone_rotations(const HandMotions& hands);

}  // namespace telemime
