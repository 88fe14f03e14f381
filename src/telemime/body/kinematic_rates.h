// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "telemime/body/body.h"

namespace telemime {

/// How a body moves while one number of its pose grows by one unit (m or rad) a second. Camera frame.
struct KinematicRate {
  std::array<Eigen::Vector3d, kSegmentCount> angular;  ///< rad/s, by Segment
  JointPositions joints;                               ///< m/s
};

/// The derivatives of forward_kinematics() with respect to the numbers of a pose, in the order of
/// Pose::vector(): the geometric Jacobian. `kinematics` are those of `pose`.
std::array<KinematicRate, kPoseSize> kinematic_rates(const Body& body, const Pose& pose,
                                                     const Kinematics& kinematics);

}  // namespace telemime
