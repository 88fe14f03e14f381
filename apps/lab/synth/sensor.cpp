// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/sensor.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cmath>

#include "telemime/core/random.h"

namespace telemime {

cv::Mat develop(const cv::Mat& light, const Sensor& sensor, std::uint64_t seed, std::uint64_t frame) {
  // One stream per row, one more for the frame's gain.
  const std::uint64_t first = (frame + 1) << 20;
  Random gain_random(seed, first);
  const auto gain = static_cast<float>(255.0 * (1.0 + gain_random.normal(0.0, sensor.flicker)));
  cv::Mat picture(light.size(), CV_8UC3);
  tbb::parallel_for(tbb::blocked_range<int>(0, light.rows), [&](const tbb::blocked_range<int>& range) {
    for (int y = range.begin(); y < range.end(); ++y) {
      Random random(seed, first + 1 + static_cast<std::uint64_t>(y));
      const auto* in = light.ptr<cv::Vec3f>(y);
      auto* out = picture.ptr<cv::Vec3b>(y);
      for (int x = 0; x < light.cols; ++x) {
        for (int c = 0; c < 3; ++c) {
          const float value = gain * std::sqrt(std::max(in[x][c], 0.0f));
          const double noise = sensor.noise > 0.0 ? random.normal(0.0, sensor.noise) : 0.0;
          out[x][c] = cv::saturate_cast<uchar>(static_cast<double>(value) + noise);
        }
      }
    }
  });
  return picture;
}

}  // namespace telemime
