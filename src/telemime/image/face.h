// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <opencv2/core/types.hpp>
#include <opencv2/objdetect.hpp>
#include <optional>

namespace telemime {

/// Where the trained face cascades are searched, after `folder` (when not empty).
std::filesystem::path find_cascade(const std::filesystem::path& folder, const std::string& name);

/// A second opinion on a face square: colour, place.
using FaceTest = std::function<bool(const cv::Rect&)>;

/// Viola-Jones face detector of OpenCV (P. Viola, M. Jones, CVPR 2001; thesis 2.4.4.1), frontal and profile.
class FaceDetector {
 public:
  /// Loads haarcascade_frontalface_alt2.xml and haarcascade_profileface.xml from `folder`, or from the places
  /// where packages of OpenCV put them. Throws Error(config) that names the places searched.
  explicit FaceDetector(const std::filesystem::path& folder = {});

  /// The largest face in `region` of a grey picture (CV_8UC1), with sides between smallest and largest
  /// pixels; square, in pixels of the whole picture, and passing `is_face`. `profiles`: also try faces seen
  /// from the side.
  std::optional<cv::Rect> find(const cv::Mat& grey, const cv::Rect& region, int smallest, int largest,
                               bool profiles, const FaceTest& is_face);

 private:
  cv::CascadeClassifier frontal_;
  cv::CascadeClassifier profile_;
};

}  // namespace telemime
