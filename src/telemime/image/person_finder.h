// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>

#include "telemime/nets/find_pose.h"

namespace telemime {

/// Finds one person with learned networks and follows them from frame to frame. Copies share the networks:
/// two of them must not be used at the same time.
class PersonFinder {
 public:
  /// Without networks: it never finds anybody.
  PersonFinder() = default;
  /// Reads the networks from this folder (find_models). Throws Error(config).
  explicit PersonFinder(const std::filesystem::path& models);

  bool has_networks() const { return networks_ != nullptr; }

  /// The landmarks and the mask of the person in the next picture (CV_8UC3, BGR), in its pixels.
  std::optional<PoseLandmarks> find(const cv::Mat& picture);

  /// Forgets where the person was.
  void reset() { region_.reset(); }

 private:
  std::shared_ptr<PoseNetworks> networks_;
  std::optional<PictureRegion> region_;
};

/// The landmarks in the pixels of the same picture at another size; the mask, too.
PoseLandmarks scaled_to(PoseLandmarks landmarks, cv::Size from, cv::Size to);

/// The square in which a detector of frontal faces sees this head, in pixels of the landmarks. Empty if the
/// face is not in the picture.
std::optional<cv::Rect2d> face_square(const PoseLandmarks& landmarks);

/// What a person mask (CV_8UC1, 255 is 1) adds to the energy of the background: positive inside the person.
/// -2 ln of the odds, within +-`most`.
cv::Mat mask_energy(const cv::Mat& mask, float most);

}  // namespace telemime
