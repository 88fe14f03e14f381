// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "telemime/body/motion_frame.h"
#include "telemime/evaluation/truth.h"

namespace telemime {

/// How far the head, as the face holds it, is from the truth.
struct HeadReport {
  std::size_t heads = 0;        ///< true heads, each frame counted
  double seen = 0.0;            ///< share of these with a confidence of at least 0.5; the rest is over them
  std::optional<double> angle;  ///< rad, mean of the rotation between estimate and truth
  std::optional<double> angle_p95;
  /// rad, means of the sizes of its parts about the axes of the true head: nod, turn, tilt.
  std::optional<double> pitch, yaw, roll;
};

/// The rotation vector (rad) from the true head to the estimated one, in the axes of the true head.
Eigen::Vector3d head_error(const Eigen::Quaterniond& estimate, const Eigen::Quaterniond& truth);

/// Over scored, tracked frames. Nothing if the truth knows no head or no frame has a face.
std::optional<HeadReport> measure_heads(const std::vector<MotionFrame>& frames, const Truth& truth);

}  // namespace telemime
