// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <functional>

#include "telemime/body/arm_ik.h"
#include "telemime/body/limits.h"
#include "telemime/search/simplex.h"

namespace telemime {

/// One part of the pose as a search space. The other parts keep the values of the pose it was made from.
struct SearchBlock {
  Eigen::VectorXd start;
  Eigen::VectorXd steps;  ///< extent of the initial simplex: factor x typical frame-to-frame change
  Bounds bounds;
  std::function<Pose(const Eigen::VectorXd&)> decode;
};

/// Bounds (m) of the root and the wrists in a search: along the camera's axis, and beside it. No person whom
/// a calibration may place (calibration.farthest) lies beyond.
inline constexpr double kNearestSearched = 0.2, kFarthestSearched = 50.0, kMostAsideSearched = 50.0;

/// All 23 pose numbers (m and rad): the search space of the thesis.
SearchBlock whole_block(const Pose& pose, const JointLimits& limits, double factor);

/// Root translation and rotation, and neck (9 numbers). The wrists keep their positions as far as they are in
/// reach, so that trunk and arms are searched independently.
SearchBlock trunk_block(const Body& body, const Pose& pose, const JointLimits& limits, double factor);

/// One arm in end-effector space: the wrist along its viewing ray (x/z, y/z, z), swivel, and the hand's
/// flexion, pivot and twisting (7 numbers). A wrist out of reach is moved to the nearest point in reach.
SearchBlock arm_block(const Body& body, const Pose& pose, Side side, const JointLimits& limits,
                      double factor);

/// Pose that belongs to a point of arm_block().
Pose with_arm(const Body& body, const Pose& pose, Side side, const Eigen::VectorXd& point,
              const JointLimits& limits);

/// One arm by the directions of its bones: rotations of upper arm and forearm in the image plane and in depth
/// (rad), and the hand's flexion, pivot and twisting (7 numbers). The forearm keeps its direction when the
/// upper arm turns.
SearchBlock bones_block(const Body& body, const Pose& pose, Side side, const JointLimits& limits,
                        double factor);

/// `count` of a block's numbers from `first` on; the others keep their start. Does not refer to `block`.
SearchBlock part_of(const SearchBlock& block, Eigen::Index first, Eigen::Index count);

/// The pose with one wrist and swivel at the target, or at the nearest point in reach.
Pose with_wrist(const Body& body, const Pose& pose, Side side, const ArmTarget& target,
                const JointLimits& limits);

}  // namespace telemime
