// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/distance_map.h"

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace telemime {

cv::Mat distance_map(const cv::Mat& edges, double cap) {
  // Without a single zero distanceTransform returns its own large number: the cap covers that case too.
  cv::Mat inverted;
  cv::compare(edges, 0, inverted, cv::CMP_EQ);
  cv::Mat distance;
  cv::distanceTransform(inverted, distance, cv::DIST_L2, cv::DIST_MASK_5, CV_32F);
  cv::min(distance, cap, distance);
  return distance;
}

}  // namespace telemime
