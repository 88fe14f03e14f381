// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

namespace telemime {

/// Image derivatives, grey levels per pixel; x right, y down. Both (h x w) CV_32FC1.
struct Gradient {
  cv::Mat dx;
  cv::Mat dy;
};

/// Recursive first derivative of Deriche: h(n) ~ n exp(-alpha |n|) across, (alpha |n| + 1) exp(-alpha |n|)
/// along the edge, scaled so that a ramp of slope 1 answers 1. Borders are repeated outwards. The cost does
/// not depend on alpha; small alpha smooths more (1 is about a Gaussian of 1.5 pixels).
/// R. Deriche, Using Canny's criteria to derive a recursively implemented optimal edge detector, IJCV 1,
/// 1987; Fast algorithms for low-level vision, PAMI 12(1), 1990. Thesis 3.4.1 and 3.5.1. grey: CV_8UC1 or
/// CV_32FC1, not empty. alpha in (0, 10]. Throws Error(usage) otherwise.
Gradient deriche_gradient(const cv::Mat& grey, double alpha);

}  // namespace telemime
