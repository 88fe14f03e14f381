// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string_view>

namespace telemime {

/// The background subtractions that the thesis compares (3.4.3, Table 3-1, Figure 3-6), and ours.
enum class Subtraction {
  rgb_difference,  ///< largest difference of a channel from the mean picture
  mixture,         ///< OpenCV's MOG2 (Z. Zivkovic, 2004), shadows on
  reference,       ///< chroma and gradient direction, thesis 3.4.2
  robust,          ///< chroma and luminance with shadows and local gain (background_model.h); the default
};
inline constexpr std::string_view kSubtractionNames[] = {"rgb-difference", "mixture", "reference", "robust"};

/// Foreground of a picture (CV_8UC3 of the size learned) by one of the methods: 255, else 0. All have the
/// same clean-up: opening, then closing, with a 3x3 square. It may adapt: pictures in the order of time. For
/// comparisons; FeatureExtractor uses the robust energies directly.
using Subtractor = std::function<cv::Mat(const cv::Mat& bgr)>;

/// Learns from pictures (CV_8UC3, one size) without a person. Throws Error(usage) when there is none.
Subtractor make_subtractor(Subtraction method, std::span<const cv::Mat> pictures);

/// The background model of the thesis (3.4.1): per pixel, over N person-free pictures, the mean and
/// covariance of the chroma (Cr, Cb) and the circular mean and variance of the gradient's direction (Deriche
/// on grey). Covariances are regularised: 8-bit steps make them singular. Directions are weighed by the
/// gradient's length, because a weak gradient has none. All planes are CV_32FC1.
struct ReferenceBackground {
  cv::Mat cr, cb;                              ///< mean chroma less 128, grey levels
  cv::Mat inverse_rr, inverse_rb, inverse_bb;  ///< inverse covariance of the chroma
  cv::Mat direction_x, direction_y;            ///< unit vector of the mean direction
  cv::Mat direction_variance;                  ///< rad^2
  cv::Mat strength;                            ///< mean length of the gradient, grey levels per pixel
};

/// Throws Error(usage) without pictures (CV_8UC3, one size).
ReferenceBackground learn_reference_background(std::span<const cv::Mat> pictures);

/// Foreground, before any clean-up: 255 where it is less probable than `threshold` in (0, 1) that the
/// background gives a value at least as far from its mean. The probability is the larger of chroma's (2
/// degrees of freedom) and direction's (1) - equation 3.12 with tail probabilities in the place of densities,
/// which could not be compared. Direction counts only where image and background both have a gradient.
cv::Mat reference_foreground(const ReferenceBackground& model, const cv::Mat& bgr, double threshold);

}  // namespace telemime
