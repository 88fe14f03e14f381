// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

namespace telemime {

/// Image derivatives, grey levels per pixel; x right, y down. Both (h x w) CV_32FC1.
struct Gradient {
  cv::Mat dx;
  cv::Mat dy;
};

/// Derivatives of a grey image (CV_8UC1 or CV_32FC1) by the recursive filter of Deriche: n exp(-alpha |n|)
/// across the edge and (alpha |n| + 1) exp(-alpha |n|) along it, scaled so that a ramp of slope 1 gives 1.
/// Borders are replicated. The smaller alpha, the more the filter smooths (1 is about a Gaussian of 1.5
/// pixels); the time does not depend on it. Throws Error(usage) for an empty or colour image and for alpha
/// outside (0, 10]. R. Deriche, Using Canny's criteria to derive a recursively implemented optimal edge
/// detector, IJCV 1, 1987; Fast algorithms for low-level vision, PAMI 12(1), 1990. Thesis 3.4.1 and 3.5.1.
Gradient deriche_gradient(const cv::Mat& grey, double alpha);

}  // namespace telemime
