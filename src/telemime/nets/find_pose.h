// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <optional>

#include "telemime/nets/network.h"
#include "telemime/nets/pose_landmarks.h"

namespace telemime {

/// The networks that find a person and the points of the body.
struct PoseNetworks {
  Network detector;
  Network landmarker;
  MaskNetworks mask;
};

/// Reads the networks from the folder of the models (find_models()). Throws Error(config) if one is missing.
PoseNetworks load_pose_networks(const std::filesystem::path& models, PoseModel model = PoseModel::full);

/// The landmarks and the mask of one person in a BGR picture (CV_8UC3). `previous` is next_region of the
/// frame before; the detector runs only without it or if nobody is there any more. Empty if nobody is found.
std::optional<PoseLandmarks> find_pose(const cv::Mat& picture, PoseNetworks& networks,
                                       const std::optional<PictureRegion>& previous = std::nullopt);

}  // namespace telemime
