// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>

namespace telemime {

/// Pinhole camera. Camera frame: x right, y down, z forward, metres. Pixel (0, 0) is the CENTRE of the
/// top-left pixel (the convention of OpenCV), so an image spans [-0.5, width - 0.5] x [-0.5, height - 0.5].
struct Camera {
  int width = 640;
  int height = 480;
  double fx = 554.2563;
  double fy = 554.2563;
  double cx = 319.5;
  double cy = 239.5;
  /// k1 k2 p1 p2 k3 of OpenCV's model; all zero when the image has no distortion or was undistorted.
  std::array<double, 5> distortion{};

  /// Camera-frame point (m) to pixel [u, v], without distortion. z must be positive.
  Eigen::Vector2d project(const Eigen::Vector3d& point) const;

  /// Direction (not normalised, z = 1) of the viewing ray through pixel [u, v], camera frame.
  Eigen::Vector3d ray(const Eigen::Vector2d& pixel) const;

  /// Distance (m) of a plane parallel to the image in which `length` metres span `pixels` pixels.
  double distance_of(double length, double pixels) const { return fx * length / pixels; }

  /// The same camera seen through an image of another size (pixel areas scale, centres stay centres).
  Camera scaled_to(int new_width, int new_height) const;

  /// A pixel of this camera's image to the same point in the image of `other` (a scaled_to of it).
  Eigen::Vector2d pixel_in(const Camera& other, const Eigen::Vector2d& pixel) const;
};

/// The width of a 4:3 image with as many pixels, px. Lengths in working images are shares of it: a camera
/// that is held upright sees the same person at the same size.
double reference_width(int width, int height);

/// Camera with square pixels, principal point in the middle, and this field of view (degrees, in (1, 179))
/// along the LONGER side, which does not change when the camera is turned upright. Throws Error(usage)
/// outside.
Camera camera_from_field_of_view(int width, int height, double degrees);

/// Reads an OpenCV calibration (YAML, XML or JSON by cv::FileStorage: camera_matrix, distortion_coefficients,
/// image_width, image_height) or a plain JSON object with fx, fy, cx, cy, width, height. Throws Error(config)
/// that names the file and what is missing.
Camera load_camera(const std::filesystem::path& file);

}  // namespace telemime
