// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/record_queue.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace telemime {

void keep_picture(int longest_side, Frame& frame) {
  if (longest_side == 0) {
    frame.image.release();
    return;
  }
  const int side = std::max(frame.image.cols, frame.image.rows);
  if (side > longest_side) {
    const double scale = static_cast<double>(longest_side) / side;
    cv::Mat small;
    cv::resize(frame.image, small, {}, scale, scale, cv::INTER_AREA);
    frame.image = small;
  }
}

}  // namespace telemime
