// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

#include "telemime/nets/network.h"
#include "telemime/nets/picture_region.h"

namespace telemime {

/// A person that the detector has found, in pixels of the picture.
struct PoseDetection {
  double score = 0.0;                        ///< (0.5, 1]
  Eigen::Vector4d box;                       ///< of the face: left, top, right, bottom
  std::array<Eigen::Vector2d, 4> keypoints;  ///< middle of the hips; a point that gives size and direction of
                                             ///< the body; middle of the shoulders; a point of the upper body
};

/// The network pose_detection: a single-shot detector for people at any place of a picture.
Network load_pose_detector(const std::filesystem::path& models);

/// The people in a BGR picture (CV_8UC3), the best first. Overlapping candidates are averaged by score.
std::vector<PoseDetection> detect_poses(const cv::Mat& picture, Network& detector);

/// The region in which landmarks of the person are to be searched.
PictureRegion region_of(const PoseDetection& detection);

}  // namespace telemime
