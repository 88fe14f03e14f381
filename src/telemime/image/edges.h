// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

#include "telemime/image/deriche.h"

namespace telemime {

/// Edge pixels of a gradient (CV_8UC1: 255 on edges, otherwise 0) by non-maximum suppression and hysteresis.
/// An edge pixel's magnitude is a local maximum along the gradient (linearly interpolated between
/// neighbours), at least `low`, and connected (8 neighbours) to a pixel of at least `high`; both in grey
/// levels per pixel. Pixels where `mask` (CV_8UC1, same size) is 0 and the outermost pixels of the image are
/// never edges. Thesis 3.5.1. Throws Error(usage) if the sizes differ or unless 0 <= low <= high.
cv::Mat find_edges(const Gradient& gradient, const cv::Mat& mask, double low, double high);

/// Distance in pixels from each pixel to the nearest edge pixel (edges: CV_8UC1, not 0 on edges), at most
/// `cap` (> 0); `cap` everywhere if there is no edge. CV_32FC1. The 5x5 chamfer distance (G. Borgefors,
/// Distance transformations in digital images, 1986) is within 2.5 % of the Euclidean distance. The values
/// equal those of OpenCV's distanceTransform (without IPP) to the last bit, in less time. Thesis 3.5.1.
cv::Mat distance_map(const cv::Mat& edges, double cap);

}  // namespace telemime
