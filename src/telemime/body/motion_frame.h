// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "telemime/body/pose.h"
#include "telemime/body/skeleton.h"
#include "telemime/core/camera.h"

namespace telemime {

enum class TrackState { lost, tracking };

/// How sure the tracker is of a pose.
struct PoseSpread {
  /// Of each joint's place as seen from the middle of the shoulders: covariance (m^2, camera axes). What is
  /// not known of the person's size is in it.
  std::array<Eigen::Matrix3d, kJointCount> covariance{};
  double second_mode = 0.0;          ///< weight of the second-best mode, in [0, 1]
  double effective_particles = 0.0;  ///< how many particles carry the estimate
};

/// What one frame gives to the outputs: the pose and everything that they may want to say about it.
struct MotionFrame {
  std::int64_t frame = 0;  ///< from 0, every input frame
  double time = 0.0;       ///< s
  TrackState state = TrackState::lost;
  Pose pose;              ///< when lost: the last known (or the rest) pose, not to be trusted
  JointPositions joints;  ///< m, camera frame
  std::array<Eigen::Vector2d, kJointCount> pixels{};  ///< of the INPUT image, integer = pixel centre
  std::optional<PoseSpread> spread;                   ///< nothing from searches that keep one pose alone
  double region_score = 0.0;                          ///< F, in [0, 1]
  double contour_score = 0.0;                         ///< D_C, pixels of the working image
  int evaluations = 0;
  std::vector<std::pair<std::string, double>> stage_ms;  ///< time of each stage, ms
};

}  // namespace telemime
