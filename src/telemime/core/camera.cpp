// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "telemime/core/errors.h"
#include "telemime/core/json_field.h"

namespace telemime {
namespace {

constexpr int kLargestSide = 32768;

}  // namespace

Eigen::Vector2d Camera::project(const Eigen::Vector3d& point) const {
  return {fx * point.x() / point.z() + cx, fy * point.y() / point.z() + cy};
}

Eigen::Vector3d Camera::ray(const Eigen::Vector2d& pixel) const {
  return {(pixel.x() - cx) / fx, (pixel.y() - cy) / fy, 1.0};
}

Camera Camera::scaled_to(int new_width, int new_height) const {
  const double sx = static_cast<double>(new_width) / width;
  const double sy = static_cast<double>(new_height) / height;
  Camera scaled = *this;
  scaled.width = new_width;
  scaled.height = new_height;
  scaled.fx = fx * sx;
  scaled.fy = fy * sy;
  scaled.cx = (cx + 0.5) * sx - 0.5;
  scaled.cy = (cy + 0.5) * sy - 0.5;
  return scaled;
}

Eigen::Vector2d Camera::pixel_in(const Camera& other, const Eigen::Vector2d& pixel) const {
  return {(pixel.x() + 0.5) * other.width / width - 0.5, (pixel.y() + 0.5) * other.height / height - 0.5};
}

double reference_width(int width, int height) {
  return std::sqrt(4.0 / 3.0 * width * height);
}

Camera camera_from_field_of_view(int width, int height, double degrees) {
  if (!(degrees > 1.0 && degrees < 179.0)) {
    throw Error(ErrorKind::usage, "a field of view of " + std::to_string(degrees) + " degrees is impossible",
                "Give the field of view along the longer side between 1 and 179 degrees; most webcams have "
                "55 to 80.");
  }
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = 0.5 * std::max(width, height) / std::tan(0.5 * degrees * std::numbers::pi / 180.0);
  camera.fy = camera.fx;
  camera.cx = 0.5 * (width - 1);
  camera.cy = 0.5 * (height - 1);
  return camera;
}

Camera read_camera(const JsonField& object) {
  Camera camera;
  camera.width = static_cast<int>(object["width"].integer(1, kLargestSide));
  camera.height = static_cast<int>(object["height"].integer(1, kLargestSide));
  camera.fx = object["fx"].positive();
  camera.fy = object["fy"].positive();
  camera.cx = object["cx"].number();
  camera.cy = object["cy"].number();
  if (object.has("distortion")) {
    camera.distortion = object["distortion"].numbers<5>();
  }
  return camera;
}

}  // namespace telemime
