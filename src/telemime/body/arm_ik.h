// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <optional>

#include "telemime/body/body.h"
#include "telemime/body/limits.h"

namespace telemime {

/// One arm in end-effector space (thesis 4.4.2.3): the position of the wrist, and the rotation of the elbow
/// about the line from shoulder to wrist.
struct ArmTarget {
  Eigen::Vector3d wrist;  ///< m, camera frame
  double swivel = 0.0;    ///< rad, (-pi, pi]; 0: the elbow as low as it can be (in the chest's frame)
};

/// The four angles of one arm, rad.
struct ArmAngles {
  double flexion = 0.0;
  double twisting = 0.0;
  double abduct = 0.0;
  double elbow = 0.0;
};

ArmAngles arm_angles(const Pose& pose, Side side);
void set_arm_angles(Pose& pose, Side side, const ArmAngles& angles);

/// The end-effector description of the arm of a pose.
ArmTarget arm_target(const Body& body, const Pose& pose, Side side);

/// Closed-form inverse kinematics (Tolani, Goswami & Badler, Graphical Models 62, 2000): the angles that
/// bring the wrist to this position, for the chest of `pose`; the motion of the shoulder with the clavicle is
/// solved by a few fixed-point steps. Empty if the wrist is out of reach. Of the two decompositions of the
/// shoulder rotation, one inside `limits` is preferred, then the one nearer to the arm of `pose`. The angles
/// may be outside `limits`.
std::optional<ArmAngles> solve_arm(const Body& body, const Pose& pose, Side side, const ArmTarget& target,
                                   const JointLimits& limits);

/// Inverse kinematics from joint positions (m, camera frame): the nearest arm whose segments point from the
/// shoulder to `elbow` and from there to `wrist`. Lengths are those of the body: only directions matter.
ArmAngles arm_through(const Body& body, const Pose& pose, Side side, const Eigen::Vector3d& elbow,
                      const Eigen::Vector3d& wrist, const JointLimits& limits);

}  // namespace telemime
