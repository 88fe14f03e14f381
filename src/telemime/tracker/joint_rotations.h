// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "telemime/body/pose.h"

namespace telemime {

/// A pose as what turns and moves, free of the jumps that angles make: near flexion -90 degrees a shoulder's
/// abduct and twisting are ill-defined one by one, but its rotation is not.
struct JointRotations {
  Eigen::Vector3d root;                        ///< m, camera frame
  std::array<Eigen::Quaterniond, 6> rotation;  ///< trunk, neck, shoulders (l, r), wrists (l, r)
  std::array<double, 2> elbow{};               ///< l, r; rad
};

JointRotations rotations_of(const Pose& pose);

/// The inverse. Of the angles that give the same rotation it takes those nearest to `near`'s, whole turns
/// included.
Pose pose_of(const JointRotations& rotations, const Pose& near);

/// Rotation vector from one orientation to another, rad, in the frame of the first.
Eigen::Vector3d turn_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to);

}  // namespace telemime
