// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "telemime/image/deriche.h"

namespace telemime {

/// Edge pixels (255, else 0; CV_8UC1) of a gradient: its magnitude is a local maximum along its direction
/// (linear interpolation between the neighbours), at least `low`, and connected (8 neighbours) to one of at
/// least `high`, grey levels per pixel. Only pixels where `mask` (CV_8UC1, same size) is not 0. The outermost
/// pixels of the picture are never edges. Thesis 3.5.1. Throws Error(usage) on sizes that differ or
/// unless 0 <= low <= high.
cv::Mat find_edges(const Gradient& gradient, const cv::Mat& mask, double low, double high);

}  // namespace telemime
