// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace telemime {

/// Rotation about one axis of the body frame, right-hand rule, rad.
inline Eigen::Matrix3d rotation_x(double a) {
  const double c = std::cos(a);
  const double s = std::sin(a);
  Eigen::Matrix3d m;
  m << 1, 0, 0, 0, c, -s, 0, s, c;
  return m;
}
inline Eigen::Matrix3d rotation_y(double a) {
  const double c = std::cos(a);
  const double s = std::sin(a);
  Eigen::Matrix3d m;
  m << c, 0, s, 0, 1, 0, -s, 0, c;
  return m;
}
inline Eigen::Matrix3d rotation_z(double a) {
  const double c = std::cos(a);
  const double s = std::sin(a);
  Eigen::Matrix3d m;
  m << c, -s, 0, s, c, 0, 0, 0, 1;
  return m;
}

/// Angles of R = Rz(z) Rx(x) Ry(y): root, neck and shoulder (thesis 2.4.2).
struct AnglesZxy {
  double z = 0.0;
  double x = 0.0;
  double y = 0.0;
};

/// R = Rz Rx Ry.
Eigen::Matrix3d compose_zxy(const AnglesZxy& angles);

/// The two decompositions of a rotation as Rz Rx Ry: first with x in [-pi/2, pi/2], then its twin with
/// x' = pi - x. Every angle wrapped to (-pi, pi]. At x = +-pi/2 (arm straight ahead) y is set to 0.
std::array<AnglesZxy, 2> decompose_zxy(const Eigen::Matrix3d& rotation);

/// The shortest rotation that turns the direction of `from` into that of `to`, by any axis across them if
/// they are opposite. Neither may be zero.
Eigen::Quaterniond rotation_between(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

/// The rotation R that fits points best to others, given the sum of w to from^T over centred points with
/// weights w: the one with the smallest sum of w |to - R from|^2 (Kabsch, Acta Crystallographica A34, 1978).
Eigen::Matrix3d best_rotation(const Eigen::Matrix3d& covariance);

/// a wrapped to (-pi, pi].
double wrap_angle(double a);

}  // namespace telemime
