// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "telemime/body/body.h"

namespace telemime {

/// Common properties of skeletons in a T-pose (facing +z, x to their own left, y up) of all file formats.

/// +1 left, -1 right: the sign of x.
double side_sign(Side side);

/// Rotation from the hanging arm of the rest pose to the arm of the T-pose.
Eigen::Matrix3d t_pose_from_rest(Side side);

/// The inner end of the clavicle, m, chest frame.
Eigen::Vector3d collar_in_chest(const Body& body, Side side);

/// Angle (rad) about the vertical between the direction in which a trunk (by its rotation in the world) faces
/// and +z; 0 for a lying trunk.
double heading(const Eigen::Matrix3d& trunk);

/// Plausible legs, which are not tracked, for retargeters that need a whole person. Fractions of stature.
struct LegProportions {
  double hips_below_root = 0.03;
  double hip_half_width = 0.05;
  double thigh = 0.225;
  double shank = 0.225;
  double ankle_height = 0.032;
  double foot_length = 0.11;
};

}  // namespace telemime
