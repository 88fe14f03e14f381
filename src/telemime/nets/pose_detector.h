// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

#include "telemime/nets/network.h"
#include "telemime/nets/picture_region.h"
#include "telemime/nets/single_shot.h"

namespace telemime {

/// The network pose_detection: a single-shot detector for people at any place of a picture.
Network load_pose_detector(const std::filesystem::path& models);

/// The people in a BGR picture (CV_8UC3), the best first. The box is that of the face; keypoints: middle of
/// the hips; a point that gives size and direction of the body; middle of the shoulders; a point of the upper
/// body.
std::vector<Detection> detect_poses(const cv::Mat& picture, Network& detector);

/// The region in which landmarks of a person of detect_poses() are to be searched.
PictureRegion region_of_person(const Detection& person);

}  // namespace telemime
