// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <span>
#include <vector>

#include "telemime/image/log_colour.h"

namespace telemime {

/// A Gaussian of colours [u, v, l] (see LogColour), with a weight among its siblings.
struct ColourGaussian {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();
  Eigen::Matrix3f covariance = Eigen::Matrix3f::Identity();
  float weight = 1.0F;
};

/// A class of colours: one Gaussian or a few. Empty: nothing is known of the class.
using ColourMixture = std::vector<ColourGaussian>;

/// How far a fitted Gaussian is widened.
struct ColourTolerance {
  float chroma = 0.04F;     ///< added to the deviation of u and v (root of the sum of squares)
  float luminance = 0.10F;  ///< the same for l
  float stretch = 1.5F;  ///< the deviation along l is multiplied by this: limbs lie in other light than faces
  float slope = 0.5F;    ///< how much chroma may change with l at most (skin is more saturated in the shade)
};

/// Gaussian of the samples after repeated trimming around the median: outliers (eyes, beard, a mask among
/// skin) up to nearly half of the samples do not move it. At least 8 samples; throws Error(usage) with fewer.
ColourGaussian fit_robust(std::span<const Eigen::Vector3f> samples, const ColourTolerance& tolerance);

/// Up to `most` Gaussians by k-means with starts far apart; no random numbers. Groups that hold less than
/// 4 % of the samples are dropped, groups nearer than the tolerance merged. At least 8 samples.
ColourMixture fit_mixture(std::span<const Eigen::Vector3f> samples, int most,
                          const ColourTolerance& tolerance);

/// -2 ln of the mixture's density (best component) at one colour, without the 3 ln 2 pi that all share.
float energy(const ColourMixture& mixture, const Eigen::Vector3f& colour);

/// The same at every pixel; CV_32FC1. A large constant where the mixture is empty.
cv::Mat energy(const ColourMixture& mixture, const LogColour& picture);

/// Squared Mahalanobis distance of one colour from the nearest component.
float mahalanobis2(const ColourMixture& mixture, const Eigen::Vector3f& colour);

}  // namespace telemime
