// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace telemime {

/// A short synthetic film of 160x120 in which a lamp comes on at the middle frame.
struct LightClip {
  std::vector<cv::Mat> empty;     ///< CV_8UC3, the room without the person
  std::vector<cv::Mat> pictures;  ///< CV_8UC3
  std::vector<cv::Mat> truth;     ///< CV_8UC1, 255 where the person is
};

/// Same seed, same pixels. frames >= 1.
LightClip make_light_clip(std::uint64_t seed, int frames);

}  // namespace telemime
