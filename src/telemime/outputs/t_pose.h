// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "telemime/body/body.h"

namespace telemime {

/// What skeletons in a T-pose (facing +z, x to their own left, y up) share, whatever the file format.

/// +1 left, -1 right: the sign of x.
double side_sign(Side side);

/// From the hanging arm of our rest pose to the arm of the T-pose.
Eigen::Matrix3d t_pose_from_rest(Side side);

/// The inner end of the clavicle, m, chest frame.
Eigen::Vector3d collar_in_chest(const Body& body, Side side);

/// Angle (rad) about the vertical by which a trunk (its rotation in the world) faces away from +z; 0 for one
/// that lies.
double heading(const Eigen::Matrix3d& trunk);

/// What is not tracked: plausible, so that a retargeter sees a whole person who stands. Fractions of stature.
struct LegProportions {
  double hips_below_root = 0.03;
  double hip_half_width = 0.05;
  double thigh = 0.225;
  double shank = 0.225;
  double ankle_height = 0.032;
  double foot_length = 0.11;
};

}  // namespace telemime
