// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "telemime/body/face_motion.h"
#include "telemime/body/hand_motion.h"
#include "telemime/body/pose.h"
#include "telemime/body/skeleton.h"
#include "telemime/core/camera.h"

namespace telemime {

enum class TrackState { lost, tracking };

/// Uncertainty of a pose.
struct PoseSpread {
  /// Covariance of each joint relative to the middle of the shoulders (m^2, camera axes), the uncertainty of
  /// the person's size included.
  std::array<Eigen::Matrix3d, kJointCount> covariance{};
  double second_mode = 0.0;          ///< weight of the second-best mode, in [0, 1]
  double effective_particles = 0.0;  ///< effective number of particles
};

/// The result of one frame for the outputs: the pose and its description.
struct MotionFrame {
  std::int64_t frame = 0;  ///< from 0, every input frame
  double time = 0.0;       ///< s
  TrackState state = TrackState::lost;
  Pose pose;                                          ///< when lost: the last known pose, or the rest pose
  JointPositions joints;                              ///< m, camera frame
  std::array<Eigen::Vector2d, kJointCount> pixels{};  ///< of the INPUT image, integer = pixel centre
  std::optional<HandMotions> hands;                   ///< empty: hands are not tracked
  std::optional<FaceMotion> face;                     ///< empty: no face was looked for or none is seen
  std::optional<PoseSpread> spread;                   ///< empty for methods that keep a single pose
  double region_score = 0.0;                          ///< F, in [0, 1]
  double contour_score = 0.0;                         ///< D_C, pixels of the working image
  int evaluations = 0;
  std::vector<std::pair<std::string, double>> stage_ms;  ///< time of each stage, ms
};

}  // namespace telemime
