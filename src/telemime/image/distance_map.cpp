// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/distance_map.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace telemime {

cv::Mat distance_map(const cv::Mat& edges, double cap) {
  cv::Mat distance(edges.size(), CV_32FC1, cv::Scalar(cap));
  const cv::Rect edged = cv::boundingRect(edges);
  if (edged.empty()) {
    return distance;
  }
  // A step of the chamfer goes a column or a row at a cost of at least one: farther away all is at the cap.
  const int reach = static_cast<int>(std::min(std::ceil(cap), 1.0 * (edges.cols + edges.rows)));
  const cv::Rect near = cv::Rect(edged.tl() - cv::Point(reach, reach), edged.br() + cv::Point(reach, reach)) &
                        cv::Rect(cv::Point(0, 0), edges.size());
  cv::Mat inverted;
  cv::compare(edges(near), 0, inverted, cv::CMP_EQ);
  cv::Mat exact;
  cv::distanceTransform(inverted, exact, cv::DIST_L2, cv::DIST_MASK_5, CV_32F);
  cv::min(exact, cap, distance(near));
  return distance;
}

}  // namespace telemime
