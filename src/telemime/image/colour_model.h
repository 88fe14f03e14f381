// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "telemime/image/log_colour.h"

namespace telemime {

/// A Gaussian over colours [u, v, l] (see LogColour), with its weight in a mixture.
struct ColourGaussian {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  Eigen::Matrix3f covariance = Eigen::Matrix3f::Identity();
  float weight = 1.0F;
};

/// The colours of a class as a mixture of a few Gaussians. Empty: the colours are not known.
using ColourMixture = std::vector<ColourGaussian>;

/// How much a fitted Gaussian is widened.
struct ColourTolerance {
  float chroma = 0.04F;     ///< added to the deviation of u and v (root of the sum of squares)
  float luminance = 0.10F;  ///< added to the deviation of l in the same way
  float stretch = 1.5F;     ///< factor of the deviation of l: limbs are lit differently from faces
  float slope = 0.5F;       ///< largest change of chroma with l (skin is more saturated in the shade)
};

/// Fits a Gaussian by repeated trimming around the median. Outliers (eyes, a beard or a mask among skin) do
/// not affect it, up to nearly half of the samples. Throws Error(usage) for fewer than 8 samples.
ColourGaussian fit_robust(std::span<const Eigen::Vector3f> samples, const ColourTolerance& tolerance);

/// Fits up to `most` Gaussians by k-means with starts that are far apart; deterministic. A new group is
/// started only for samples that are far from all groups; groups with less than 4 % of the samples are
/// dropped. Throws Error(usage) for fewer than 8 samples.
ColourMixture fit_mixture(std::span<const Eigen::Vector3f> samples, int most,
                          const ColourTolerance& tolerance);

/// Energy of each pixel (CV_32FC1): -2 ln of the density of the best component, without the constant
/// 3 ln 2 pi. A large constant for an empty mixture.
cv::Mat energy(const ColourMixture& mixture, const LogColour& image);

/// Squared Mahalanobis distance of a colour to the nearest component; the largest float for an empty mixture.
float mahalanobis2(const ColourMixture& mixture, const Eigen::Vector3f& colour);

}  // namespace telemime
