// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
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

/// Low-passed velocity of one quantity, and from it the share of the present of the quantity.
class SpeedShare {
 public:
  void reset() { velocity_.setZero(); }
  double operator()(const Eigen::Vector3d& change, double step, const OneEuroOptions& options) {
    velocity_ += low_pass_share(options.speed_cutoff, step) * (change / step - velocity_);
    return low_pass_share(options.minimum_cutoff + options.slope * velocity_.norm(), step);
  }

 private:
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();
};

}  // namespace telemime
