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

  /// The part of find() that needs no pose, so that it can run beside the search for the pose of the same
  /// picture: it looks where the face was. find() for this time then starts from what was seen there; it
  /// finds the same without it.
  void prepare(const cv::Mat& picture, double time);

  /// The face in the next picture (CV_8UC3, BGR), in its pixels; `person` is in pixels of an image of size
  /// `working` that shows the same. `time` is that of the picture, s.
  std::optional<FaceLandmarks> find(const cv::Mat& picture, const PoseLandmarks& person, cv::Size working,
                                    double time);

 private:
  /// What was seen where the face was.
  struct Seen {
    double time = 0.0;
    std::optional<FaceLandmarks> face;
  };
  std::shared_ptr<FaceNetworks> networks_;
  std::optional<PictureRegion> region_;  ///< in which to look for the face in the next picture
  std::optional<Seen> prepared_;
};

}  // namespace telemime
