// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace telemime::support {

/// The picture (CV_8UC3) as a camera without colours sees it; it still has three channels.
inline cv::Mat grey(const cv::Mat& picture) {
  cv::Mat out;
  cv::cvtColor(picture, out, cv::COLOR_BGR2GRAY);
  cv::cvtColor(out, out, cv::COLOR_GRAY2BGR);
  return out;
}

}  // namespace telemime::support
