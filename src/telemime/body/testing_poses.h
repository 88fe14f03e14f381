// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <numbers>
#include <utility>

#include "telemime/body/arm_ik.h"
#include "telemime/body/arm_parts.h"
#include "telemime/body/body.h"
#include "telemime/body/limits.h"
#include "telemime/core/random.h"

/// Poses for tests of several modules. Not installed.
namespace telemime::testing_poses {

inline constexpr double kDegree = std::numbers::pi / 180.0;
inline constexpr std::array<Side, 2> kSides = {Side::left, Side::right};

/// Every angle uniform inside the limits; the trunk's within `trunk` of its range; 1.0 to 1.6 m before the
/// camera.
inline Pose random_pose(const JointLimits& limits, Random& random, double trunk = 1.0) {
  Pose pose;
  pose.root = {random.uniform(-0.2, 0.2), random.uniform(0.2, 0.5), random.uniform(1.0, 1.6)};
  for (std::size_t a = 0; a < kAngleCount; ++a) {
    const double share = a <= static_cast<std::size_t>(Angle::neck_tilt) ? trunk : 1.0;
    pose.angles[a] = share * random.uniform(limits.min[a], limits.max[a]);
  }
  return pose;
}

/// A random pose whose arms are bent: straight ones have no swivel.
inline Pose bent_pose(const JointLimits& limits, Random& random) {
  Pose pose = random_pose(limits, random, 0.4);
  for (const Side side : kSides) {
    ArmAngles arm = arm_angles(pose, side);
    arm.elbow = std::min(arm.elbow, -15 * kDegree);
    set_arm_angles(pose, side, arm);
  }
  return pose;
}

/// Largest distance of a joint, m.
inline double farthest_joint(const JointPositions& a, const JointPositions& b) {
  double most = 0.0;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    most = std::max(most, (a.at[j] - b.at[j]).norm());
  }
  return most;
}

/// A body with other proportions, the same on both sides.
inline Shape other_shape() {
  Shape shape;
  shape.stature = 1.82;
  shape[Segment::chest] = {1.05, 1.1, 0.93};
  shape[Segment::head] = {0.97, 1.02, 1.04};
  shape[Segment::l_upper_arm] = shape[Segment::r_upper_arm] = {1.06, 0.9, 1.2};
  shape[Segment::l_forearm] = shape[Segment::r_forearm] = {0.94, 1.1, 1.05};
  shape[Segment::l_hand] = shape[Segment::r_hand] = {1.03, 0.95, 1.0};
  shape.sleeve = 0.7;
  return shape;
}

/// The same joint on the other side.
inline Joint twin(Joint joint) {
  for (const auto part : {&ArmParts::shoulder, &ArmParts::elbow, &ArmParts::wrist, &ArmParts::knuckle}) {
    const auto [left, right] = std::pair{kArmParts[0].*part, kArmParts[1].*part};
    if (joint == left || joint == right) {
      return joint == left ? right : left;
    }
  }
  return joint;
}

}  // namespace telemime::testing_poses
