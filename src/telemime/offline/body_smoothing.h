// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <deque>
#include <optional>

#include "telemime/core/camera.h"
#include "telemime/tracker/interval_smoother.h"
#include "telemime/tracker/joint_rotations.h"
#include "telemime/tracker/rotation_noise.h"
#include "telemime/tracker/smoother.h"

namespace telemime {

/// The pose of a frame as it was measured.
struct MeasuredPose {
  double time = 0.0;  ///< s
  JointRotations rotations;
  NoiseRatios noise;
};

/// What is known at one time of all that moves.
struct BodyState {
  double time = 0.0;  ///< s
  IntervalState<3> root;
  std::array<IntervalState<4>, 6> rotation;  ///< quaternions times two, so that noise is in rad
  std::array<IntervalState<1>, 2> elbow;
};

/// The first of `poses` in the light of all of them and of `before`, the state at the pose before it, which
/// is replaced by that at the first. `poses` must not be empty; no gap may be between them.
JointRotations smoothed_first(const FileSmoothing& options, const std::deque<MeasuredPose>& poses,
                              std::optional<BodyState>& before);

}  // namespace telemime
