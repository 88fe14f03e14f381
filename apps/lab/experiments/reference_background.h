// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <opencv2/core/mat.hpp>
#include <span>

namespace telemime {

/// The background model of the thesis (3.4.1): per pixel, over N person-free pictures, the mean and
/// covariance of the chroma (Cr, Cb) and the circular mean and variance of the gradient's direction (Deriche
/// on grey). Covariances are regularised: 8-bit steps make them singular. Directions are weighed by the
/// gradient's length, because a weak gradient has none.
struct ReferenceBackground {
  cv::Mat chroma_mean;         ///< (h x w) CV_32FC2, [Cr, Cb], grey levels
  cv::Mat chroma_inverse;      ///< CV_32FC3: xx, xy, yy of the inverse covariance
  cv::Mat direction;           ///< CV_32FC2, unit vector of the mean direction
  cv::Mat direction_variance;  ///< CV_32FC1, rad^2
  cv::Mat strength;            ///< CV_32FC1, mean length of the gradient, grey levels per pixel
};

/// Throws Error(usage) without pictures (CV_8UC3, one size).
ReferenceBackground learn_reference_background(std::span<const cv::Mat> pictures);

/// Probability in [0, 1], per pixel, that the background gives a value at least as far from its mean: the
/// larger of chroma's (2 degrees of freedom) and direction's (1) - equation 3.12 with tail probabilities in
/// the place of densities, which could not be compared. Direction counts only where image and background
/// both have a gradient. CV_32FC1.
cv::Mat reference_probability(const ReferenceBackground& model, const cv::Mat& bgr);

/// 255 where that probability is below `threshold` in (0, 1): foreground, before any clean-up. The same
/// answer without a logarithm or exponential per pixel.
cv::Mat reference_foreground(const ReferenceBackground& model, const cv::Mat& bgr, double threshold);

}  // namespace telemime
