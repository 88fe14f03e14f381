// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/t_pose.h"

#include <cmath>
#include <numbers>

#include "telemime/body/rotations.h"

namespace telemime {
namespace {

// Fractions of stature, from C7.
constexpr double kCollarSide = 0.012;
constexpr double kCollarBelowNeck = 0.035;
constexpr double kCollarForward = 0.020;

}  // namespace

double side_sign(Side side) {
  return side == Side::left ? 1.0 : -1.0;
}

Eigen::Matrix3d t_pose_from_rest(Side side) {
  return rotation_z(side_sign(side) * std::numbers::pi / 2.0);
}

Eigen::Vector3d collar_in_chest(const Body& body, Side side) {
  return body.neck_from_root + body.shape.stature * Eigen::Vector3d(side_sign(side) * kCollarSide,
                                                                    -kCollarBelowNeck, kCollarForward);
}

double heading(const Eigen::Matrix3d& trunk) {
  const Eigen::Vector3d front = trunk.col(2);
  return std::hypot(front.x(), front.z()) > 1e-6 ? std::atan2(front.x(), front.z()) : 0.0;
}

}  // namespace telemime
