// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>

namespace telemime {

/// The colour model of the thesis (2.4.4.1): one Gaussian of hue and saturation. Hue is an angle: the mean is
/// circular and differences are taken around it, so that red, on both ends of the scale, is one colour.
struct HueModel {
  float hue = 0.0F;         ///< mean, radians in [0, 2 pi)
  float saturation = 0.0F;  ///< mean, [0, 1]
  cv::Matx22f inverse;      ///< of the regularised covariance of [hue difference, saturation]
  bool coloured = true;     ///< false: so little saturation that hue means nothing (grey, black, white)
};

/// From the pixels of `bgr` (CV_8UC3) where `mask` (CV_8UC1) is not 0. Throws Error(usage) with fewer than 8.
HueModel learn_hue(const cv::Mat& bgr, const cv::Mat& mask);

/// Squared Mahalanobis distance at every pixel (CV_32FC1). For skin and clothes a threshold of 9 keeps 99 %
/// of a Gaussian; the normalisation that the printed densities (2.3, 2.4) lack makes no difference to a
/// threshold.
cv::Mat hue_distance2(const HueModel& model, const cv::Mat& bgr);

}  // namespace telemime
