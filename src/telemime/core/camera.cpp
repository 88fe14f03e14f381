// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/core/files.h"
#include "telemime/core/json_field.h"

namespace telemime {
namespace {

constexpr int kLargestSide = 32768;
constexpr const char* kRemedy =
    "Give an OpenCV calibration (camera_matrix, image_width, image_height) or use --fov DEGREES.";

Error broken(const std::filesystem::path& file, const std::string& why) {
  return {ErrorKind::config, "camera file " + file.string() + ": " + why, kRemedy};
}

void check(const Camera& camera, const std::filesystem::path& file) {
  const bool finite = std::isfinite(camera.fx) && std::isfinite(camera.fy) && std::isfinite(camera.cx) &&
                      std::isfinite(camera.cy) &&
                      std::all_of(camera.distortion.begin(), camera.distortion.end(),
                                  [](double k) { return std::isfinite(k); });
  if (!finite) {
    throw broken(file, "a number is not finite");
  }
  if (camera.width <= 0 || camera.height <= 0 || camera.width > kLargestSide ||
      camera.height > kLargestSide) {
    throw broken(file, "the image size must be between 1 and 32768 pixels");
  }
  if (camera.fx <= 0.0 || camera.fy <= 0.0) {
    throw broken(file, "the focal length must be positive");
  }
}

// A JSON file with fx instead of a camera matrix. By default the pixels are square, the axis is central and
// the last numbers of the distortion are 0.
std::optional<Camera> from_plain_json(const std::filesystem::path& file) {
  const JsonSource source{"camera file " + file.string(), ErrorKind::config, kRemedy};
  auto json = parse_if_json(read_text_file(file, ErrorKind::config), source);
  if (!json || !json->contains("fx")) {
    return std::nullopt;
  }
  const JsonField field(*json, source);
  json->emplace("fy", json->at("fx"));
  json->emplace("cx", (field["width"].number() - 1.0) / 2.0);
  json->emplace("cy", (field["height"].number() - 1.0) / 2.0);
  if (const auto distortion = json->find("distortion"); distortion != json->end()) {
    while (distortion->is_array() && distortion->size() < Camera().distortion.size()) {
      distortion->push_back(0.0);
    }
  }
  return read_camera(field);
}

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

Camera camera_from_field_of_view(int width, int height, double degrees) {
  if (!(degrees > 1.0 && degrees < 179.0)) {
    throw Error(ErrorKind::usage, "a field of view of " + std::to_string(degrees) + " degrees is impossible",
                "Give the horizontal field of view between 1 and 179 degrees; most webcams have 55 to 80.");
  }
  Camera camera;
  camera.width = width;
  camera.height = height;
  camera.fx = 0.5 * width / std::tan(0.5 * degrees * std::numbers::pi / 180.0);
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

Camera load_camera(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) {
    throw broken(file, "no such file");
  }
  if (const auto plain = from_plain_json(file)) {
    return *plain;
  }
  Camera camera;
  try {
    const cv::FileStorage storage(file.string(), cv::FileStorage::READ);
    if (!storage.isOpened() || storage["camera_matrix"].empty()) {
      throw broken(file, "it has no camera_matrix");
    }
    cv::Mat matrix;
    cv::Mat distortion;
    storage["camera_matrix"] >> matrix;
    storage["distortion_coefficients"] >> distortion;
    if (matrix.rows != 3 || matrix.cols != 3 || matrix.channels() != 1 || distortion.channels() != 1) {
      throw broken(file, "camera_matrix is not 3 x 3");
    }
    matrix.convertTo(matrix, CV_64F);
    camera.fx = matrix.at<double>(0, 0);
    camera.fy = matrix.at<double>(1, 1);
    camera.cx = matrix.at<double>(0, 2);
    camera.cy = matrix.at<double>(1, 2);
    camera.width = static_cast<int>(storage["image_width"]);
    camera.height = static_cast<int>(storage["image_height"]);
    if (!distortion.empty()) {
      distortion.convertTo(distortion, CV_64F);
      const std::vector<double> numbers(distortion.begin<double>(), distortion.end<double>());
      const std::size_t used = std::min(numbers.size(), camera.distortion.size());
      if (std::any_of(numbers.begin() + used, numbers.end(), [](double number) { return number != 0.0; })) {
        throw broken(file, "of the distortion_coefficients, only k1 k2 p1 p2 k3 may differ from 0");
      }
      std::copy_n(numbers.begin(), used, camera.distortion.begin());
    }
  } catch (const cv::Exception&) {
    throw broken(file, "it is not YAML, XML or JSON that OpenCV can read");
  }
  check(camera, file);
  return camera;
}

}  // namespace telemime
