// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/euler.h"

#include <cmath>
#include <numbers>

#include "telemime/body/rotations.h"

namespace telemime {
namespace {

constexpr double kSingular = 1e-7;  // cosine of the middle angle

Eigen::Matrix3d rotation_about(int axis, double angle) {
  return axis == 0 ? rotation_x(angle) : axis == 1 ? rotation_y(angle) : rotation_z(angle);
}

double distance(const EulerAngles& a, const EulerAngles& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    sum += std::abs(wrap_angle(a[i] - b[i]));
  }
  return sum;
}

}  // namespace

Eigen::Matrix3d compose(const AxisOrder& order, const EulerAngles& angles) {
  return rotation_about(order[0], angles[0]) * rotation_about(order[1], angles[1]) *
         rotation_about(order[2], angles[2]);
}

EulerAngles decompose(const Eigen::Matrix3d& r, const AxisOrder& order, const EulerAngles& near) {
  const auto [i, j, k] = order;
  const double parity = (i + 1) % 3 == j ? 1.0 : -1.0;  // +1 for xyz and its cyclic shifts
  const double cosine = std::hypot(r(i, i), r(i, j));
  const double middle = std::atan2(parity * r(i, k), cosine);
  if (cosine < kSingular) {
    const double inner = wrap_angle(near[2]);
    const Eigen::Matrix3d rest = r * rotation_about(k, -inner);
    return {std::atan2(parity * rest(k, j), rest(j, j)), middle, inner};
  }
  const double outer = std::atan2(-parity * r(j, k), r(k, k));
  const double inner = std::atan2(-parity * r(i, j), r(i, i));
  const EulerAngles first = {outer, middle, inner};
  const EulerAngles second = {wrap_angle(outer + std::numbers::pi), wrap_angle(std::numbers::pi - middle),
                              wrap_angle(inner + std::numbers::pi)};
  return distance(first, near) <= distance(second, near) ? first : second;
}

}  // namespace telemime
