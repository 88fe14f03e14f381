// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>

#include "telemime/nets/network.h"
#include "telemime/nets/person_mask.h"
#include "telemime/nets/picture_region.h"
#include "telemime/nets/pose_model.h"

namespace telemime {

/// Indices of the landmarks that joints of the model correspond to; left is the person's own.
struct PoseLandmarkIndex {
  enum : int {
    nose = 0,
    left_eye = 2,
    right_eye = 5,
    left_ear = 7,
    right_ear = 8,
    mouth_left = 9,
    mouth_right = 10,
    left_shoulder = 11,
    right_shoulder = 12,
    left_elbow = 13,
    right_elbow = 14,
    left_wrist = 15,
    right_wrist = 16,
    left_pinky = 17,
    right_pinky = 18,
    left_index = 19,
    right_index = 20,
    left_thumb = 21,
    right_thumb = 22,
    left_hip = 23,
    right_hip = 24,
    left_knee = 25,
    right_knee = 26,
    left_ankle = 27,
    right_ankle = 28,
  };
};

/// A point of the body.
struct PoseLandmark {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();       ///< of the picture
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();  ///< of pixel, px^2, from the spread of the heat map
  double depth = 0.0;       ///< behind the hips (z forward), in pixels as the picture's axes; a rough value
  double visibility = 0.0;  ///< probability that it is in the picture and not hidden
  double presence = 0.0;    ///< probability that it is in the picture
  Eigen::Vector3d world =
      Eigen::Vector3d::Zero();  ///< m from the middle of the hips, axes of the camera frame
};

/// What the network sees of a person.
struct PoseLandmarks {
  static constexpr std::size_t kCount = 33;
  std::array<PoseLandmark, kCount> points;
  double score = 0.0;         ///< probability that a person is in the region
  PictureRegion region;       ///< in which the person was seen
  PictureRegion next_region;  ///< in which to look for the person in the next frame
  cv::Mat
      mask;  ///< CV_8UC1 of the picture's size: probability of the person, 255 is 1; empty if not computed
};

/// What a network sees of a person; the mask is not computed yet.
struct SeenPerson {
  PoseLandmarks landmarks;
  MaskInput mask;  ///< of person_mask()
};

/// The network that sees landmarks. Throws Error(config) if it is missing.
Network load_pose_landmarker(const std::filesystem::path& models, PoseModel model);

/// The person in this region of a BGR picture (CV_8UC3); empty if the network sees nobody. `landmarker` was
/// made by load_pose_landmarker().
std::optional<SeenPerson> find_landmarks(const cv::Mat& picture, const PictureRegion& region,
                                         Network& landmarker);

}  // namespace telemime
