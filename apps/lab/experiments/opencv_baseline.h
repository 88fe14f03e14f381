// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>

#include "telemime/likelihood/backend.h"

namespace telemime {

/// The evaluation with OpenCV, to measure others against. Neither is exact: outlines are half a pixel wider.

/// The thesis step by step, each with the call that OpenCV has for it: vertices by cv::projectPoints, the
/// triangles that face the camera filled from the farthest to the nearest, images for the sets of
/// equation 2.5, the contour drawn as lines that nearer triangles paint over, its mean distance by cv::mean.
std::unique_ptr<Backend> make_literal_opencv();

/// The same optimised for speed: vertices projected by hand, segment after segment by one depth for each,
/// class and contour in one image, memory used again.
std::unique_ptr<Backend> make_opencv_baseline();

}  // namespace telemime
