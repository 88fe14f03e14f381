// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>

namespace telemime {

/// One picture as it came from the camera or file. Its pixels are never changed; a record may replace or
/// release the picture.
struct Frame {
  cv::Mat image;           ///< (height x width) CV_8UC3, BGR, not mirrored
  std::int64_t index = 0;  ///< from 0, counts every input frame
  double time = 0.0;       ///< seconds from the first frame
  double taken = 0.0;      ///< seconds of the source's clock when it was taken, of live inputs; others: 0
};

}  // namespace telemime
