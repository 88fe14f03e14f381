// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

namespace telemime {

/// Distance in pixels from every pixel to the nearest edge pixel (edges: CV_8UC1, 255 on edges), capped at
/// `cap` (> 0); everywhere `cap` when there is no edge. CV_32FC1. The 5x5 chamfer of
/// OpenCV's distanceTransform (without IPP) to the last bit, in less time, within 2.5 % of the
/// Euclidean distance (G. Borgefors, Distance transformations in digital images, 1986). Thesis 3.5.1.
cv::Mat distance_map(const cv::Mat& edges, double cap);

}  // namespace telemime
