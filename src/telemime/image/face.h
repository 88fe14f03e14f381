// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <opencv2/core/types.hpp>
#include <opencv2/objdetect.hpp>
#include <optional>

namespace telemime {

/// Path of the cascade file `name` in `folder` or, if that is empty, in share/opencv4/haarcascades beside the
/// folder of the running program (a program that brings its libraries) and in the usual folders of OpenCV.
/// Throws Error(config) that names the folders searched.
std::filesystem::path find_cascade(const std::filesystem::path& folder, const std::string& name);

/// Whether a detected square can be a face, for instance by its colour.
using FaceTest = std::function<bool(const cv::Rect&)>;

/// OpenCV's Viola-Jones detector for frontal faces (P. Viola, M. Jones, CVPR 2001; thesis 2.4.4.1).
class FaceDetector {
 public:
  /// Loads haarcascade_frontalface_alt2.xml (see find_cascade). Throws Error(config) if it is missing or
  /// cannot be read.
  explicit FaceDetector(const std::filesystem::path& folder = {});

  /// The largest face in `region` of a grey image (CV_8UC1) that satisfies `is_face`, as a square in pixels
  /// of the whole image with sides between `smallest` and `largest`. Empty if there is none.
  std::optional<cv::Rect> find(const cv::Mat& grey, const cv::Rect& region, int smallest, int largest,
                               const FaceTest& is_face);

 private:
  cv::CascadeClassifier frontal_;
};

}  // namespace telemime
