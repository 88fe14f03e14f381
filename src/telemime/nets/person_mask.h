// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

#include "telemime/nets/network.h"

namespace telemime {

/// Input of the segmentation: 256 x 256 pixels, or 256 x 144 in half the time.
enum class MaskModel { square, landscape };

/// The network selfie_segmentation or selfie_segmentation_landscape.
Network load_person_segmenter(const std::filesystem::path& models, MaskModel model);

/// The probability that a pixel of a BGR picture (CV_8UC3) shows a person: CV_8UC1 of the picture's size, 255
/// is 1. Made for people within 2 m of the camera.
cv::Mat find_person_mask(const cv::Mat& picture, Network& segmenter);

}  // namespace telemime
