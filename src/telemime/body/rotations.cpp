// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/rotations.h"

#include <Eigen/SVD>
#include <numbers>

namespace telemime {

double wrap_angle(double a) {
  constexpr double turn = 2.0 * std::numbers::pi;
  a = std::fmod(a, turn);
  if (a > std::numbers::pi) {
    return a - turn;
  }
  return a <= -std::numbers::pi ? a + turn : a;
}

Eigen::Matrix3d compose_zxy(const AnglesZxy& angles) {
  return rotation_z(angles.z) * rotation_x(angles.x) * rotation_y(angles.y);
}

std::array<AnglesZxy, 2> decompose_zxy(const Eigen::Matrix3d& r) {
  // Second column (-sin z cos x, cos z cos x, sin x); third row (-cos x sin y, sin x, cos x cos y).
  const double cosine = std::hypot(r(0, 1), r(1, 1));
  AnglesZxy first;
  first.x = std::atan2(r(2, 1), cosine);
  if (cosine > 1e-9) {
    first.z = std::atan2(-r(0, 1), r(1, 1));
    first.y = std::atan2(-r(2, 0), r(2, 2));
  } else {
    first.z = std::atan2(r(1, 0), r(0, 0));
  }
  const AnglesZxy second = {wrap_angle(first.z + std::numbers::pi), wrap_angle(std::numbers::pi - first.x),
                            wrap_angle(first.y + std::numbers::pi)};
  return {first, second};
}

Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  return Eigen::Quaterniond::FromTwoVectors(from, to);
}

Eigen::Matrix3d best_rotation(const Eigen::Matrix3d& covariance) {
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  sign.z() = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace telemime
