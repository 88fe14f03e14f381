// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace telemime {

/// A simple camera sensor.
struct Sensor {
  double noise = 2.0;  ///< standard deviation, grey levels of 0..255, each channel of each pixel on its own
  double flicker = 0.004;  ///< standard deviation of the gain from frame to frame
};

/// Linear light (CV_32FC3) to the picture that the camera gives (CV_8UC3, BGR, gamma 2). The noise of a pixel
/// depends on seed, `frame` and the pixel alone, whatever the number of threads.
cv::Mat develop(const cv::Mat& light, const Sensor& sensor, std::uint64_t seed, std::uint64_t frame);

}  // namespace telemime
