// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/packed_rotation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace telemime::meeting {
namespace {

constexpr int kComponentBits = 15;
constexpr std::uint64_t kComponentMask = (1U << kComponentBits) - 1U;
constexpr double kSteps = 32767.0;
constexpr double kMostSquares = 1.0 + 1e-3;

std::uint64_t quantised(double v) {
  const double step = std::floor((v * std::numbers::sqrt2 + 1.0) / 2.0 * kSteps + 0.5);
  return static_cast<std::uint64_t>(std::clamp(step, 0.0, kSteps));
}

double component(std::uint64_t step) {
  return (2.0 * static_cast<double>(step) / kSteps - 1.0) / std::numbers::sqrt2;
}

}  // namespace

std::uint64_t pack_rotation(const Eigen::Quaterniond& rotation) {
  const Eigen::Vector4d q = rotation.coeffs().normalized();  // x y z w
  int largest = 0;
  for (int i = 1; i < 4; ++i) {
    if (std::abs(q[i]) > std::abs(q[largest])) {
      largest = i;
    }
  }
  const double sign = q[largest] < 0.0 ? -1.0 : 1.0;
  std::uint64_t bits = static_cast<std::uint64_t>(largest) << (3 * kComponentBits);
  int shift = 0;
  for (int i = 0; i < 4; ++i) {
    if (i != largest) {
      bits |= quantised(sign * q[i]) << shift;
      shift += kComponentBits;
    }
  }
  return bits;
}

std::optional<Eigen::Quaterniond> unpack_rotation(std::uint64_t bits) {
  std::array<double, 3> three{};
  double squares = 0.0;
  for (double& v : three) {
    v = component(bits & kComponentMask);
    bits >>= kComponentBits;
    squares += v * v;
  }
  if (squares > kMostSquares) {
    return std::nullopt;
  }
  const auto largest = static_cast<int>(bits & 3U);
  Eigen::Vector4d q;
  std::size_t next = 0;
  for (int i = 0; i < 4; ++i) {
    q[i] = i == largest ? std::sqrt(std::max(0.0, 1.0 - squares)) : three[next++];
  }
  return Eigen::Quaterniond(q.normalized());
}

}  // namespace telemime::meeting
