// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

namespace telemime {

/// How a quantity moves and how exactly it is measured, in its unit (m, rad) and seconds.
struct IntervalModel {
  double noise = 1.0;   ///< standard deviation of a measurement
  double motion = 1.0;  ///< root of the spectral density of the acceleration: unit / s^1.5
  double sudden = 2.0;  ///< degrees of freedom of the acceleration; fewer allow stronger sudden changes
};

/// A measured quantity of N numbers.
template <int N>
struct IntervalSample {
  Eigen::Matrix<double, 1, N> value;
  double step = 0.0;   ///< s since the sample before it
  double ratio = 1.0;  ///< of its variance to noise^2
};

/// What is known at one time: value and velocity (rows) of N numbers, with the covariance of the two, which
/// is the same for all N.
template <int N>
struct IntervalState {
  Eigen::Matrix<double, 2, N> mean = Eigen::Matrix<double, 2, N>::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
};

namespace interval {

inline Eigen::Matrix2d transition(double step) {
  return (Eigen::Matrix2d() << 1.0, step, 0.0, 1.0).finished();
}

/// Covariance of what white acceleration of density 1 adds in `step` seconds.
inline Eigen::Matrix2d acceleration(double step) {
  const double s = step * step / 2.0;
  return (Eigen::Matrix2d() << step * step * step / 3.0, s, s, step).finished();
}

}  // namespace interval

/// The first of `samples` in the light of all of them, and of `before`, the state at the sample before the
/// first, which is replaced by that at the first. Nothing before it: the first sample starts a motion.
///
/// The Kalman smoother of Rauch, Tung & Striebel (AIAA Journal 3, 1965) for a velocity that changes by random
/// accelerations. These have Student's t distribution with `model.sudden` degrees of freedom in place of the
/// normal one, so that a steady motion is smoothed strongly and a sudden one is followed at once: each step
/// has a factor of its density that is estimated from the smoothed motion itself, in turn with it
/// (expectation maximisation; Lange, Little & Taylor, JASA 84, 1989).
template <int N>
Eigen::Matrix<double, 1, N> smoothed_first(const IntervalModel& model,
                                           std::span<const IntervalSample<N>> samples,
                                           std::optional<IntervalState<N>>& before) {
  using State = IntervalState<N>;
  constexpr int kPasses = 4;  // the factors change by a few percent after three
  const double noise = model.noise * model.noise;
  const double density = model.motion * model.motion;

  // State 0 is the one before the samples, if there is one; without it the first sample is.
  const std::size_t first = before ? 1 : 0;
  const std::size_t count = samples.size() + first;
  const auto sample = [&](std::size_t t) -> const IntervalSample<N>& { return samples[t - first]; };
  std::vector<State> predicted(count), filtered(count), smoothed(count);
  std::vector<Eigen::Matrix2d> gain(count);
  std::vector<double> factor(count, 1.0);
  if (before) {
    filtered[0] = *before;
  } else {
    // At rest, to within what a second of random accelerations brings.
    filtered[0].mean << sample(0).value, Eigen::Matrix<double, 1, N>::Zero();
    filtered[0].covariance = Eigen::Vector2d(noise * sample(0).ratio, density).asDiagonal();
  }

  for (int pass = 0; pass < kPasses; ++pass) {
    // Forward: what each sample says of its own time.
    for (std::size_t t = 1; t < count; ++t) {
      const Eigen::Matrix2d f = interval::transition(sample(t).step);
      predicted[t].mean = f * filtered[t - 1].mean;
      predicted[t].covariance = f * filtered[t - 1].covariance * f.transpose() +
                                density * factor[t] * interval::acceleration(sample(t).step);
      const Eigen::Matrix2d& p = predicted[t].covariance;
      const Eigen::Vector2d share = p.col(0) / (p(0, 0) + noise * sample(t).ratio);
      filtered[t].mean = predicted[t].mean + share * (sample(t).value - predicted[t].mean.row(0));
      filtered[t].covariance = p - share * p.row(0);
    }
    // Backward: what the later samples say of it.
    smoothed[count - 1] = filtered[count - 1];
    for (std::size_t t = count - 1; t-- > 0;) {
      const Eigen::Matrix2d f = interval::transition(sample(t + 1).step);
      gain[t] = filtered[t].covariance * f.transpose() * predicted[t + 1].covariance.inverse();
      smoothed[t].mean = filtered[t].mean + gain[t] * (smoothed[t + 1].mean - predicted[t + 1].mean);
      smoothed[t].covariance =
          filtered[t].covariance +
          gain[t] * (smoothed[t + 1].covariance - predicted[t + 1].covariance) * gain[t].transpose();
    }
    // The factor of each step's density, from the expected square of what it added.
    for (std::size_t t = 1; t < count; ++t) {
      const Eigen::Matrix2d f = interval::transition(sample(t).step);
      const Eigen::Matrix<double, 2, N> added = smoothed[t].mean - f * smoothed[t - 1].mean;
      const Eigen::Matrix2d with_last = f * gain[t - 1] * smoothed[t].covariance;
      const Eigen::Matrix2d square =
          added * added.transpose() +
          N * (smoothed[t].covariance + f * smoothed[t - 1].covariance * f.transpose() - with_last -
               with_last.transpose());
      const double distance = (interval::acceleration(sample(t).step).inverse() * square).trace() / density;
      factor[t] = (model.sudden + distance) / (model.sudden + 2.0 * N);
    }
  }
  before = filtered[first];
  return smoothed[first].mean.row(0);
}

}  // namespace telemime
