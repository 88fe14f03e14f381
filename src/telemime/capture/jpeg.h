// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>

namespace telemime {

/// Decodes a JPEG file, also one of Motion JPEG without Huffman tables, to (h x w) CV_8UC3, BGR, not rotated.
/// Empty if it is visibly damaged or has more than 2^26 pixels. Unlike cv::imdecode, it returns no half-grey
/// images and writes nothing to standard error.
cv::Mat decode_jpeg(std::span<const std::uint8_t> bytes);

}  // namespace telemime
