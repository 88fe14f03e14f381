// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/camera_motion.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <vector>

namespace telemime {

std::optional<double> scene_motion(const cv::Mat& before, const cv::Mat& after, const cv::Mat& scene) {
  constexpr std::size_t kFewest = 8;
  std::vector<cv::Point2f> corners;
  cv::goodFeaturesToTrack(before, corners, 40, 0.02, 6, scene);
  if (corners.size() < kFewest) {
    return std::nullopt;
  }
  std::vector<cv::Point2f> moved;
  std::vector<unsigned char> found;
  std::vector<float> error;
  cv::calcOpticalFlowPyrLK(before, after, corners, moved, found, error, cv::Size(11, 11), 2);
  std::vector<double> lengths;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    if (found[i] != 0) {
      lengths.push_back(std::hypot(moved[i].x - corners[i].x, moved[i].y - corners[i].y));
    }
  }
  if (lengths.size() < kFewest) {
    return std::nullopt;
  }
  const auto quarter = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 4);
  std::nth_element(lengths.begin(), quarter, lengths.end());
  return *quarter;
}

}  // namespace telemime
