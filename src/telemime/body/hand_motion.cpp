// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/hand_motion.h"

#include "telemime/body/arm_parts.h"

namespace telemime {

void place_hands(const Kinematics& kinematics, HandMotions& hands) {
  for (const Side side : {Side::left, Side::right}) {
    const ArmParts& arm = arm_parts(side);
    HandMotion& hand = hands[static_cast<std::size_t>(side)];
    const Eigen::Matrix3d forearm = kinematics[arm.forearm].linear();
    const Eigen::Matrix3d turned = hand.seen ? hand.seen->toRotationMatrix() : kinematics[arm.hand].linear();
    hand.wrist = wrist_angles(forearm.transpose() * turned);
    Eigen::Isometry3d camera_from_hand = Eigen::Isometry3d::Identity();
    camera_from_hand.linear() = forearm * wrist_rotation(hand.wrist);
    camera_from_hand.translation() = kinematics.joints[arm.wrist];
    hand.joints = hand_points(hand.sizes, hand.angles, side, camera_from_hand);
  }
}

Pose with_wrists(const Pose& pose, const HandMotions& hands) {
  Pose result = pose;
  for (std::size_t side = 0; side < 2; ++side) {
    result[kArmParts[side].wrist_twisting] = hands[side].wrist.twisting;
    result[kArmParts[side].wrist_pivot] = hands[side].wrist.pivot;
    result[kArmParts[side].wrist_flexion] = hands[side].wrist.flexion;
  }
  return result;
}

HandMotions mirrored(const HandMotions& hands) {
  HandMotions result = {hands[1], hands[0]};
  for (HandMotion& hand : result) {
    if (hand.seen) {
      *hand.seen = Eigen::Quaterniond(hand.seen->w(), hand.seen->x(), -hand.seen->y(), -hand.seen->z());
    }
    hand.wrist.twisting = -hand.wrist.twisting;
    hand.wrist.flexion = -hand.wrist.flexion;
    for (Eigen::Vector3d& p : hand.joints) {
      p.x() = -p.x();
    }
  }
  return result;
}

}  // namespace telemime
