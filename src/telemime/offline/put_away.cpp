// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/put_away.h"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

namespace telemime {

void put_away(OfflineFrame& frame) {
  constexpr int kQuality = 95;    // what is drawn is compressed more
  constexpr int kWidest = 65500;  // of a JPEG, either way
  cv::Mat& image = frame.frame.image;
  if (image.empty() || std::max(image.cols, image.rows) > kWidest) {
    return;
  }
  try {
    if (cv::imencode(".jpg", image, frame.packed, {cv::IMWRITE_JPEG_QUALITY, kQuality})) {
      frame.packed.shrink_to_fit();
      image.release();
      return;
    }
  } catch (const cv::Exception&) {  // it is only kept as it is
  }
  frame.packed.clear();
}

void take_out(OfflineFrame& frame) {
  if (!frame.packed.empty()) {
    frame.frame.image = cv::imdecode(frame.packed, cv::IMREAD_COLOR);
    frame.packed = {};
  }
}

}  // namespace telemime
