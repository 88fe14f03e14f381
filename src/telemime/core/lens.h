// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "telemime/core/camera.h"

namespace telemime {

/// A calibrated camera with the distortion of its lens, in OpenCV's models.
struct Lens {
  Camera camera;         ///< without distortion
  bool fisheye = false;  ///< cv::fisheye: k1 k2 k3 k4
  /// Otherwise k1 k2 p1 p2 [k3 [k4 k5 k6 [s1 s2 s3 s4]]].
  std::vector<double> coefficients;

  /// Whether there is any distortion.
  bool distorts() const;
  /// A point of the plane z = 1 to where the lens shows it.
  Eigen::Vector2d distorted(const Eigen::Vector2d& point) const;
  /// The lens as the mirrored picture shows it.
  Lens mirrored() const;
};

/// Reads a calibration as load_camera() does, with its distortion. An OpenCV file may say which model it has:
/// by `fisheye_model` (0 or 1) or `distortion_model` (plumb_bob, rational_polynomial, equidistant, fisheye);
/// four coefficients belong to either and need it. Throws Error(config) for a file, a model or a number of
/// coefficients that cannot be used.
Lens load_lens(const std::filesystem::path& file);

}  // namespace telemime
