// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>

namespace telemime {

/// A JPEG file, as Motion JPEG holds one for each picture (also without Huffman tables), as (h x w) CV_8UC3,
/// BGR, not turned. Empty when it is damaged in any way that shows, or has more than 2^26 pixels. Unlike
/// cv::imdecode it hands out no picture that is half grey, and writes nothing to standard error.
cv::Mat decode_jpeg(std::span<const std::uint8_t> bytes);

}  // namespace telemime
