// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/lens.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

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

void check(Lens& lens, const std::filesystem::path& file) {
  const Camera& camera = lens.camera;
  std::vector<double> numbers = lens.coefficients;
  numbers.insert(numbers.end(), {camera.fx, camera.fy, camera.cx, camera.cy});
  if (!std::all_of(numbers.begin(), numbers.end(), [](double number) { return std::isfinite(number); })) {
    throw broken(file, "a number is not finite");
  }
  if (camera.width <= 0 || camera.height <= 0 || camera.width > kLargestSide ||
      camera.height > kLargestSide) {
    throw broken(file, "the image size must be between 1 and 32768 pixels");
  }
  if (camera.fx <= 0.0 || camera.fy <= 0.0) {
    throw broken(file, "the focal length must be positive");
  }
  // Zeros at the end have no effect.
  std::vector<double>& k = lens.coefficients;
  constexpr std::size_t kUntilTilt = 12;
  while (k.size() > kUntilTilt && k.back() == 0.0) {
    k.pop_back();
  }
  constexpr std::array<std::size_t, 5> kCounts = {0, 4, 5, 8, 12};
  const bool usable =
      lens.fisheye ? k.size() == 4 : std::find(kCounts.begin(), kCounts.end(), k.size()) != kCounts.end();
  if (!usable) {
    throw broken(file, std::to_string(k.size()) +
                           " distortion_coefficients are not a model that can be used: " +
                           (lens.fisheye ? "a fisheye lens has 4" : "there may be 4, 5, 8 or 12 (no tilt)"));
  }
}

// A JSON file with fx instead of a camera matrix. By default the pixels are square, the axis is central and
// the last numbers of the distortion are 0.
std::optional<Lens> from_plain_json(const std::string& text, const std::filesystem::path& file) {
  const JsonSource source{"camera file " + file.string(), ErrorKind::config, kRemedy};
  auto json = parse_if_json(text, source);
  if (!json || !json->contains("fx")) {
    return std::nullopt;
  }
  const JsonField field(*json, source);
  json->emplace("fy", json->at("fx"));
  json->emplace("cx", (field["width"].number() - 1.0) / 2.0);
  json->emplace("cy", (field["height"].number() - 1.0) / 2.0);
  Lens lens;
  lens.fisheye = field.has("fisheye") && field["fisheye"].boolean();
  if (field.has("distortion")) {
    for (std::size_t i = 0; i < field["distortion"].size(); ++i) {
      lens.coefficients.push_back(field["distortion"][i].number());
    }
    if (!lens.fisheye && lens.coefficients.size() < 5) {
      lens.coefficients.resize(5);
    }
    json->erase("distortion");
  }
  lens.camera = read_camera(field);
  return lens;
}

// Whether the file says that its lens is a fisheye; nothing if it does not name a model.
std::optional<bool> fisheye_of(const cv::FileStorage& storage, const std::filesystem::path& file) {
  if (const cv::FileNode flag = storage["fisheye_model"]; flag.isInt()) {
    return static_cast<int>(flag) != 0;
  }
  const cv::FileNode node = storage["distortion_model"];
  if (!node.isString()) {
    return std::nullopt;
  }
  const std::string model = node.string();
  if (model == "equidistant" || model == "fisheye" || model == "kannala_brandt4") {
    return true;
  }
  if (model == "plumb_bob" || model == "rational_polynomial") {
    return false;
  }
  throw broken(file, "the distortion_model '" + model + "' is not known");
}

Lens from_opencv(const std::string& text, const std::filesystem::path& file) {
  const cv::FileStorage storage(text, cv::FileStorage::READ | cv::FileStorage::MEMORY);
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
  Lens lens;
  lens.camera.fx = matrix.at<double>(0, 0);
  lens.camera.fy = matrix.at<double>(1, 1);
  lens.camera.cx = matrix.at<double>(0, 2);
  lens.camera.cy = matrix.at<double>(1, 2);
  lens.camera.width = static_cast<int>(storage["image_width"]);
  lens.camera.height = static_cast<int>(storage["image_height"]);
  if (!distortion.empty()) {
    distortion.convertTo(distortion, CV_64F);
    lens.coefficients.assign(distortion.begin<double>(), distortion.end<double>());
  }
  const std::optional<bool> fisheye = fisheye_of(storage, file);
  if (!fisheye && lens.coefficients.size() == 4 && lens.distorts()) {
    throw Error(
        ErrorKind::config,
        "camera file " + file.string() +
            ": four distortion_coefficients are those of a fisheye lens or of another one",
        "Add the line 'fisheye_model: 1' for a fisheye lens (cv::fisheye), 'fisheye_model: 0' otherwise.");
  }
  lens.fisheye = fisheye.value_or(false);
  return lens;
}

}  // namespace

bool Lens::distorts() const {
  return fisheye || std::any_of(coefficients.begin(), coefficients.end(), [](double k) { return k != 0.0; });
}

Eigen::Vector2d Lens::distorted(const Eigen::Vector2d& point) const {
  std::array<double, 12> k{};
  std::copy_n(coefficients.begin(), std::min(coefficients.size(), k.size()), k.begin());
  const double r2 = point.squaredNorm();
  if (fisheye) {
    const double r = std::sqrt(r2);
    const double angle = std::atan(r);
    const double a2 = angle * angle;
    const double bent = angle * (1.0 + a2 * (k[0] + a2 * (k[1] + a2 * (k[2] + a2 * k[3]))));
    return r > 1e-9 ? Eigen::Vector2d(point * (bent / r)) : point;
  }
  const double x = point.x();
  const double y = point.y();
  const double radial =
      (1.0 + r2 * (k[0] + r2 * (k[1] + r2 * k[4]))) / (1.0 + r2 * (k[5] + r2 * (k[6] + r2 * k[7])));
  return {x * radial + 2.0 * k[2] * x * y + k[3] * (r2 + 2.0 * x * x) + r2 * (k[8] + r2 * k[9]),
          y * radial + k[2] * (r2 + 2.0 * y * y) + 2.0 * k[3] * x * y + r2 * (k[10] + r2 * k[11])};
}

Lens Lens::mirrored() const {
  Lens other = *this;
  other.camera.cx = camera.width - 1 - camera.cx;
  if (!fisheye) {
    for (const std::size_t i : {3U, 8U, 9U}) {  // terms of x alone that are even in x
      if (i < coefficients.size()) {
        other.coefficients[i] = -coefficients[i];
      }
    }
  }
  return other;
}

Lens load_lens(const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file)) {
    throw broken(file, "no such file");
  }
  const std::string text = read_text_file(file, ErrorKind::config);
  Lens lens;
  try {
    const auto plain = from_plain_json(text, file);
    lens = plain ? *plain : from_opencv(text, file);
  } catch (const cv::Exception&) {
    throw broken(file, "it is not YAML, XML or JSON that OpenCV can read");
  }
  check(lens, file);
  return lens;
}

Camera load_camera(const std::filesystem::path& file) {
  return load_lens(file).camera;
}

}  // namespace telemime
