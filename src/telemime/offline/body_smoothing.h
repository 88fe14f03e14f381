// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <deque>
#include <optional>

#include "telemime/body/hand_motion.h"
#include "telemime/core/camera.h"
#include "telemime/tracker/interval_smoother.h"
#include "telemime/tracker/joint_rotations.h"
#include "telemime/tracker/rotation_noise.h"
#include "telemime/tracker/smoother.h"

namespace telemime {

/// A hand of a frame as it was measured; one that is not seen is at rest on the body.
struct MeasuredHand {
  HandAngles angles{};                                       ///< rad
  Eigen::Quaterniond palm = Eigen::Quaterniond::Identity();  ///< camera from hand
  double noise = 1.0;                                        ///< HandNoise::ratio()
  bool seen = false;
};

/// The pose of a frame as it was measured.
struct MeasuredPose {
  double time = 0.0;  ///< s
  JointRotations rotations;
  NoiseRatios noise;
  std::array<MeasuredHand, 2> hands{};  ///< by Side
};

/// A hand that was smoothed.
struct SmoothedHand {
  HandAngles angles{};
  Eigen::Quaterniond palm = Eigen::Quaterniond::Identity();
};

/// The pose of a frame that was smoothed.
struct SmoothedPose {
  JointRotations rotations;
  std::array<SmoothedHand, 2> hands;
};

/// What is known at one time of a hand.
struct HandInterval {
  IntervalState<static_cast<int>(kHandAngleCount)> angles;
  IntervalState<4> palm;  ///< quaternion times two
};

/// What is known at one time of all that moves.
struct BodyState {
  double time = 0.0;  ///< s
  IntervalState<3> root;
  std::array<IntervalState<4>, 6> rotation;  ///< quaternions times two, so that noise is in rad
  std::array<IntervalState<1>, 2> elbow;
  std::array<HandInterval, 2> hands;
};

/// The first of `poses` in the light of all of them and of `before`, the state at the pose before it, which
/// is replaced by that at the first. `poses` must not be empty; no gap may be between them.
SmoothedPose smoothed_first(const FileSmoothing& options, const std::deque<MeasuredPose>& poses,
                            std::optional<BodyState>& before);

}  // namespace telemime
