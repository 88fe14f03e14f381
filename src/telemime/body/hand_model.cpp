// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/hand_model.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "telemime/body/rotations.h"

namespace telemime {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr std::size_t kThumb = 0;

Eigen::Vector3d mirrored_if(Side side, const Eigen::Vector3d& p) {
  return side == Side::right ? Eigen::Vector3d(-p.x(), p.y(), p.z()) : p;
}

Eigen::Matrix3d mirrored_if(Side side, const Eigen::Matrix3d& r) {
  const Eigen::DiagonalMatrix<double, 3> mirror(-1.0, 1.0, 1.0);
  return side == Side::right ? Eigen::Matrix3d(mirror * r * mirror) : r;
}

// A finger's bone lies along -y of its base and bends toward -x. The base of the thumb is turned to the side,
// and about its own axis: it bends across the palm more than toward it.
const Eigen::Matrix3d& base_axes(std::size_t finger) {
  static const Eigen::Matrix3d identity = Eigen::Matrix3d::Identity();
  static const Eigen::Matrix3d thumb = [] {
    constexpr double kToPalm = 40.0 * kDegree;  // of the direction in which it bends
    const double half = std::numbers::sqrt2 / 2.0;
    const Eigen::Vector3d y(0.0, half, -half);
    const Eigen::Vector3d across(0.0, -half, -half);
    const Eigen::Vector3d x = -(std::cos(kToPalm) * across - std::sin(kToPalm) * Eigen::Vector3d::UnitX());
    Eigen::Matrix3d axes;
    axes << x, y, x.cross(y);
    return axes;
  }();
  return finger == kThumb ? thumb : identity;
}

// The three joints of a finger of a left hand, in the axes of its base.
std::array<Eigen::Matrix3d, 3> bends(std::size_t finger, const double* a) {
  const double last = finger == kThumb ? a[3] : kDipOfPip * a[2];
  return {rotation_z(-a[0]) * rotation_x(-a[1]), rotation_z(-a[2]), rotation_z(-last)};
}

using FingerPoints = Eigen::Matrix<double, 3, 3>;  // columns: the points after the base

FingerPoints finger_points(const HandSizes& sizes, std::size_t finger, const double* angles) {
  const auto joints = bends(finger, angles);
  Eigen::Matrix3d axes = base_axes(finger);
  Eigen::Vector3d at = sizes.base[finger];
  FingerPoints points;
  for (int i = 0; i < 3; ++i) {
    axes *= joints[static_cast<std::size_t>(i)];
    at -= sizes.bone[finger][static_cast<std::size_t>(i)] * axes.col(1);
    points.col(i) = at;
  }
  return points;
}

double within(double value, const AngleRange& range) {
  return std::clamp(value, range.min, range.max);
}

constexpr double kHandToPalm = 1.0 / 0.446;  // hand length over palm length, Buchholz et al.

HandSizes average_proportions() {
  // Knuckles beside the middle one, as shares of the palm: the distance from the wrist is that of the paper,
  // and about a finger's width lies between them.
  constexpr std::array<double, kFingerCount> kSide = {0.0, 0.25, 0.0, -0.23, -0.45};
  constexpr std::array<double, kFingerCount> kReach = {0.0, 0.463, 0.446, 0.421, 0.414};
  constexpr std::array<std::array<double, 3>, kFingerCount> kBones = {{{0.251, 0.196, 0.158},
                                                                       {0.245, 0.143, 0.097},
                                                                       {0.266, 0.170, 0.108},
                                                                       {0.244, 0.165, 0.107},
                                                                       {0.204, 0.117, 0.093}}};
  HandSizes sizes;
  for (std::size_t f = 0; f < kFingerCount; ++f) {
    const double reach = kHandToPalm * kReach[f];
    sizes.base[f] = {0.0, -std::sqrt(reach * reach - kSide[f] * kSide[f]), kSide[f]};
    for (std::size_t i = 0; i < 3; ++i) {
      sizes.bone[f][i] = kHandToPalm * kBones[f][i];
    }
  }
  sizes.base[kThumb] = {-0.1, -0.2, 0.27};
  return sizes;
}

}  // namespace

const std::array<AngleRange, kHandAngleCount>& hand_limits() {
  static const auto limits = [] {
    std::array<AngleRange, kHandAngleCount> table = {{{-30, 60}, {-40, 50}, {-15, 65}, {-20, 85}}};  // thumb
    constexpr std::array<AngleRange, 3> kFinger = {{{-20, 90}, {-20, 20}, {0, 110}}};  // MCP, spread, PIP
    for (std::size_t i = kFirstFingerAngle[1]; i < kHandAngleCount; ++i) {
      table[i] = kFinger[(i - kFirstFingerAngle[1]) % kFinger.size()];
    }
    for (AngleRange& range : table) {
      range = {range.min * kDegree, range.max * kDegree};
    }
    return table;
  }();
  return limits;
}

HandAngles resting_hand() {
  constexpr std::array<double, kHandAngleCount> kDegrees = {10, 0,  15, 15, 20, 3,  30, 22,
                                                            0,  32, 25, -3, 32, 27, -6, 30};
  HandAngles angles{};
  std::transform(kDegrees.begin(), kDegrees.end(), angles.begin(), [](double a) { return a * kDegree; });
  return angles;
}

Eigen::Matrix3d wrist_rotation(const WristAngles& angles) {
  return rotation_y(angles.twisting) * rotation_x(angles.pivot) * rotation_z(angles.flexion);
}

WristAngles wrist_angles(const Eigen::Matrix3d& forearm_from_hand) {
  // Toward the palm and the back of the hand; toward thumb and little finger. The direction of a forearm that
  // points at the camera is known to about 15 degrees only, by which these ranges are wider than a wrist's.
  constexpr double kFlexion = 85.0 * kDegree, kTwisting = 110.0 * kDegree;
  constexpr AngleRange kPivot{-45.0 * kDegree, 40.0 * kDegree};
  const Eigen::Matrix3d& r = forearm_from_hand;
  return {.twisting = std::clamp(std::atan2(r(0, 2), r(2, 2)), -kTwisting, kTwisting),
          .pivot = within(std::asin(std::clamp(-r(1, 2), -1.0, 1.0)), kPivot),
          .flexion = std::clamp(std::atan2(r(1, 0), r(1, 1)), -kFlexion, kFlexion)};
}

HandSizes average_hand(double stature) {
  static const HandSizes proportions = average_proportions();
  constexpr double kPalm = 0.0472;  // wrist centre to the third metacarpal head, of the stature
  HandSizes sizes = proportions;
  sizes.palm = kPalm * stature;
  return sizes;
}

std::array<std::array<Eigen::Matrix3d, 3>, kFingerCount> finger_rotations(const HandAngles& angles,
                                                                          Side side) {
  std::array<std::array<Eigen::Matrix3d, 3>, kFingerCount> rotations;
  for (std::size_t f = 0; f < kFingerCount; ++f) {
    const Eigen::Matrix3d& axes = base_axes(f);
    const auto joints = bends(f, &angles[kFirstFingerAngle[f]]);
    for (std::size_t i = 0; i < 3; ++i) {
      rotations[f][i] = mirrored_if(side, Eigen::Matrix3d(axes * joints[i] * axes.transpose()));
    }
  }
  return rotations;
}

HandPoints hand_points(const HandSizes& sizes, const HandAngles& angles, Side side,
                       const Eigen::Isometry3d& frame_from_hand) {
  const auto place = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    return frame_from_hand * Eigen::Vector3d(sizes.palm * mirrored_if(side, p));
  };
  HandPoints points;
  points[0] = frame_from_hand.translation();
  for (std::size_t f = 0; f < kFingerCount; ++f) {
    points[hand_joint(f, 0)] = place(sizes.base[f]);
    const FingerPoints finger = finger_points(sizes, f, &angles[kFirstFingerAngle[f]]);
    for (std::size_t i = 0; i < 3; ++i) {
      points[hand_joint(f, i + 1)] = place(finger.col(static_cast<Eigen::Index>(i)));
    }
  }
  return points;
}

std::optional<Eigen::Matrix3d> palm_rotation(const HandSizes& sizes, const HandPoints& points, Side side) {
  constexpr double kSmallest = 1e-9;
  // The palm: wrist and four knuckles, in shares of the palm's length.
  constexpr std::array<std::size_t, 5> kPalm = {0, 5, 9, 13, 17};
  Eigen::Matrix<double, 3, 5> from;
  Eigen::Matrix<double, 3, 5> to;
  for (std::size_t i = 0; i < kPalm.size(); ++i) {
    const auto column = static_cast<Eigen::Index>(i);
    from.col(column) = i == 0 ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : sizes.base[i];
    to.col(column) = mirrored_if(side, points[kPalm[i]]);
  }
  for (const Eigen::Vector3d& p : points) {
    if (!p.allFinite() || p.norm() > 1e6) {
      return std::nullopt;
    }
  }
  from.colwise() -= from.rowwise().mean().eval();
  to.colwise() -= to.rowwise().mean().eval();
  if (!(to.norm() > kSmallest * from.norm())) {
    return std::nullopt;
  }
  return mirrored_if(side, best_rotation(to * from.transpose()));
}

}  // namespace telemime
