// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace telemime {

/// Seeded generator of random numbers, the same on every platform (xoshiro256++, Blackman & Vigna 2019).
/// It is a value: copy it to branch, pass it by reference to draw. Give every independent consumer (a
/// particle, a pixel row) its own `stream`, so that results do not depend on the number of threads.
class Random {
 public:
  explicit Random(std::uint64_t seed, std::uint64_t stream = 0);

  /// 64 uniformly distributed bits.
  std::uint64_t bits();
  /// Uniform in [0, 1).
  double uniform();
  /// Uniform in [low, high).
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  /// Gaussian with the given mean and standard deviation (Box-Muller).
  double normal(double mean = 0.0, double deviation = 1.0);
  /// Uniform integer in [0, bound); bound > 0.
  std::uint32_t below(std::uint32_t bound);

 private:
  std::uint64_t state_[4]{};
  double spare_ = 0.0;
  bool has_spare_ = false;
};

}  // namespace telemime
