// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "telemime/body/pose.h"
#include "telemime/body/skeleton.h"
#include "telemime/core/camera.h"

namespace telemime {

enum class TrackState { lost, tracking };

/// What one frame gives to the outputs: the pose and everything that they may want to say about it.
struct MotionFrame {
  std::int64_t frame = 0;  ///< from 0, every input frame
  double time = 0.0;       ///< s
  TrackState state = TrackState::lost;
  Pose pose;              ///< when lost: the last known (or the rest) pose, not to be trusted
  JointPositions joints;  ///< m, camera frame
  std::array<Eigen::Vector2d, kJointCount> pixels{};  ///< of the INPUT image, integer = pixel centre
  double region_score = 0.0;                          ///< F, in [0, 1]
  double contour_score = 0.0;                         ///< D_C, pixels of the working image
  int evaluations = 0;
  std::vector<std::pair<std::string, double>> stage_ms;  ///< time of each stage, ms
};

}  // namespace telemime
