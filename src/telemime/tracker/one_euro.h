// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace telemime {

/// Cutoff frequency of a One-Euro filter: minimum + slope * speed (Casiez, Roussel & Vogel, CHI 2012).
struct OneEuroOptions {
  double minimum_cutoff = 1.0;
  double slope = 1.0;
  double speed_cutoff = 1.0;
};

/// Share of the present in a first-order low-pass; Hz, s.
inline double low_pass_share(double cutoff, double step) {
  const double tau = 1.0 / (2.0 * std::numbers::pi * cutoff);
  return step / (step + tau);
}

/// The share of the present for a measurement with `ratio` times the variance: what the gain of a Kalman
/// filter of a random walk becomes in its steady state, where gain^2 / (1 - gain) is the variance of the
/// motion over that of the measurement.
inline double with_noise(double share, double ratio) {
  if (ratio == 1.0 || share >= 1.0) {
    return share;
  }
  const double q = share * share / (1.0 - share) / ratio;
  return 0.5 * (std::sqrt(q * q + 4.0 * q) - q);
}

/// Noise of a measured quantity: `variance` of its norm, and how many times that is the variance for which
/// the cutoff frequencies were chosen.
struct MeasuredNoise {
  double variance = 0.0;
  double ratio = 1.0;
};

/// Low-passed velocity of one quantity, and from it the share of the present of the quantity. Where the noise
/// is known, only the speed that noise does not explain (three standard deviations) counts.
class SpeedShare {
 public:
  void reset() { velocity_.setZero(); }
  double operator()(const Eigen::Vector3d& change, double step, const OneEuroOptions& options,
                    const MeasuredNoise& noise = {}) {
    const double share = low_pass_share(options.speed_cutoff, step);
    velocity_ += share * (change / step - velocity_);
    // The variance of the low-passed difference quotient of white noise.
    constexpr double kCertain = 9.0;
    const double by_noise = kCertain * noise.variance * 2.0 * share * share / ((2.0 - share) * step * step);
    const double speed = std::sqrt(std::max(0.0, velocity_.squaredNorm() - by_noise));
    return with_noise(low_pass_share(options.minimum_cutoff + options.slope * speed, step), noise.ratio);
  }

 private:
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
};

}  // namespace telemime
