// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "telemime/nets/face_landmarks.h"
#include "telemime/nets/pose_landmarks.h"

namespace telemime {

/// Finds the face of a person and follows it from frame to frame: where it was in the last frame, or where
/// the pose of the body has it. Copies share the networks: two of them must not be used at the same time.
class FaceFinder {
 public:
  /// Without networks: it never looks.
  FaceFinder() = default;
  /// Reads the networks from this folder (find_models). Throws Error(config).
  explicit FaceFinder(const std::filesystem::path& models);

  bool has_networks() const { return networks_ != nullptr; }

  /// The face in the next picture (CV_8UC3, BGR), in its pixels; `person` is in pixels of an image of size
  /// `working` that shows the same.
  std::optional<FaceLandmarks> find(const cv::Mat& picture, const PoseLandmarks& person, cv::Size working);

 private:
  std::shared_ptr<FaceNetworks> networks_;
  std::optional<PictureRegion> region_;  ///< in which to look for the face in the next picture
};

}  // namespace telemime
