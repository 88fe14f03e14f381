// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/fingers.h"

#include "telemime/outputs/t_pose.h"

namespace telemime {
namespace {

void add_hand(const HandSizes& sizes, Side side, FingerSkeleton& skeleton) {
  Eigen::Isometry3d turn = Eigen::Isometry3d::Identity();
  turn.linear() = t_pose_from_rest(side);
  const HandPoints flat = hand_points(sizes, {}, side, turn);
  for (std::size_t f = 0; f < kFingerCount; ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      skeleton.position[finger_bone(side, f, i)] = flat[hand_joint(f, i)];
      skeleton.end[finger_bone(side, f, i)] = flat[hand_joint(f, i + 1)];
    }
  }
}

}  // namespace

std::string motion_builder_name(std::size_t bone) {
  constexpr std::array<const char*, kFingerCount> kFingers = {"Thumb", "Index", "Middle", "Ring", "Pinky"};
  return (side_of_finger_bone(bone) == Side::left ? "LeftHand" : "RightHand") +
         std::string(kFingers.at(bone / 3 % kFingerCount)) + std::to_string(bone % 3 + 1);
}

Eigen::Vector3d FingerSkeleton::offset(std::size_t bone) const {
  return bone % 3 == 0 ? position[bone] : Eigen::Vector3d(position[bone] - position[bone - 1]);
}

FingerSkeleton finger_skeleton(const HandSizes& left, const HandSizes& right) {
  FingerSkeleton skeleton;
  add_hand(left, Side::left, skeleton);
  add_hand(right, Side::right, skeleton);
  return skeleton;
}

FingerSkeleton finger_skeleton(const HandMotions& hands) {
  return finger_skeleton(hands[0].sizes, hands[1].sizes);
}

FingerRotations finger_bone_rotations(const HandMotions& hands) {
  FingerRotations result;
  for (const Side side : {Side::left, Side::right}) {
    const Eigen::Matrix3d t = t_pose_from_rest(side);
    const auto rotations = finger_rotations(hands[static_cast<std::size_t>(side)].angles, side);
    for (std::size_t f = 0; f < kFingerCount; ++f) {
      for (std::size_t i = 0; i < 3; ++i) {
        Eigen::Quaterniond q(Eigen::Matrix3d(t * rotations[f][i] * t.transpose()));
        q.coeffs() *= q.w() < 0.0 ? -1.0 : 1.0;
        result[finger_bone(side, f, i)] = q.normalized();
      }
    }
  }
  return result;
}

}  // namespace telemime
