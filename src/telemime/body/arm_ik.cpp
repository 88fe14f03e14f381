// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/arm_ik.h"

#include <algorithm>
#include <cmath>

#include "telemime/body/arm_parts.h"
#include "telemime/body/rotations.h"

namespace telemime {
namespace {

Eigen::Isometry3d camera_from_chest(const Pose& pose) {
  Eigen::Isometry3d t = Eigen::Isometry3d::Identity();
  t.linear() = camera_from_body_at_rest() *
               compose_zxy({pose[Angle::root_roll], pose[Angle::root_tilt], pose[Angle::root_torsion]});
  t.translation() = pose.root;
  return t;
}

// Two unit vectors across the line shoulder-wrist: the lowest direction and the one a quarter turn on.
struct SwivelFrame {
  Eigen::Vector3d low, side;
};

SwivelFrame swivel_frame(const Eigen::Vector3d& axis) {
  Eigen::Vector3d low = -Eigen::Vector3d::UnitY() + axis * axis.y();
  if (low.norm() < 1e-6) {  // the wrist is straight above or below the shoulder
    low = -Eigen::Vector3d::UnitZ() + axis * axis.z();
  }
  low.normalize();
  return {low, axis.cross(low)};
}

double excess(double value, double low, double high) {
  return std::max({0.0, low - value, value - high});
}

// The shoulder rotation whose upper arm points along `upper` and whose elbow bends toward `fore`.
ArmAngles angles_from_directions(const Eigen::Vector3d& upper, const Eigen::Vector3d& fore, const Pose& pose,
                                 Side side, const JointLimits& limits) {
  const ArmAngles before = arm_angles(pose, side);
  const double cosine = std::clamp(upper.dot(fore), -1.0, 1.0);
  const double elbow = std::acos(cosine);
  Eigen::Vector3d bend = fore - upper * cosine;
  // A straight arm says nothing about its twist: it keeps the one that it had.
  constexpr double kStraight = 1e-5;  // rad; the cosine of less is 1 but for rounding
  if (bend.norm() < kStraight) {
    const Eigen::Matrix3d old = compose_zxy({before.abduct, before.flexion, before.twisting});
    bend = old.col(2) - upper * upper.dot(old.col(2));
    if (bend.norm() < kStraight) {
      bend = upper.unitOrthogonal();
    }
  }

  const ArmParts& arm = arm_parts(side);
  const auto low = [&](Angle a) { return limits.min[static_cast<std::size_t>(a)]; };
  const auto high = [&](Angle a) { return limits.max[static_cast<std::size_t>(a)]; };
  ArmAngles best;
  double best_cost = std::numeric_limits<double>::infinity();
  // An elbow that is stretched a little too far is bent the other way at the same twist.
  for (const double sign : {-1.0, 1.0}) {
    Eigen::Matrix3d rotation;
    rotation.col(1) = -upper;
    rotation.col(2) = -sign * bend.normalized();
    rotation.col(0) = rotation.col(1).cross(rotation.col(2));
    for (const AnglesZxy& candidate : decompose_zxy(rotation)) {
      const double outside = excess(candidate.x, low(arm.shoulder_flexion), high(arm.shoulder_flexion)) +
                             excess(candidate.y, low(arm.shoulder_twisting), high(arm.shoulder_twisting)) +
                             excess(candidate.z, low(arm.shoulder_abduct), high(arm.shoulder_abduct)) +
                             excess(sign * elbow, low(arm.elbow_flexion), high(arm.elbow_flexion));
      const double away = std::abs(wrap_angle(candidate.x - before.flexion)) +
                          std::abs(wrap_angle(candidate.y - before.twisting)) +
                          std::abs(wrap_angle(candidate.z - before.abduct));
      const double cost = 1000.0 * outside + away;
      if (cost < best_cost) {
        best_cost = cost;
        best = {candidate.x, candidate.y, candidate.z, sign * elbow};
      }
    }
  }
  return best;
}

}  // namespace

ArmAngles arm_angles(const Pose& pose, Side side) {
  const ArmParts& arm = arm_parts(side);
  return {pose[arm.shoulder_flexion], pose[arm.shoulder_twisting], pose[arm.shoulder_abduct],
          pose[arm.elbow_flexion]};
}

void set_arm_angles(Pose& pose, Side side, const ArmAngles& angles) {
  const ArmParts& arm = arm_parts(side);
  pose[arm.shoulder_flexion] = angles.flexion;
  pose[arm.shoulder_twisting] = angles.twisting;
  pose[arm.shoulder_abduct] = angles.abduct;
  pose[arm.elbow_flexion] = angles.elbow;
}

ArmTarget arm_target(const Body& body, const Pose& pose, Side side) {
  const Kinematics k = forward_kinematics(body, pose);
  const ArmParts& arm = arm_parts(side);
  const Eigen::Isometry3d chest_from_camera = camera_from_chest(pose).inverse();
  const Eigen::Vector3d wrist = k.joints[arm.wrist];
  const Eigen::Vector3d s = chest_from_camera * k.joints[arm.shoulder];
  const Eigen::Vector3d e = chest_from_camera * k.joints[arm.elbow];
  const Eigen::Vector3d w = chest_from_camera * wrist;
  const SwivelFrame frame = swivel_frame((w - s).normalized());
  return {wrist, std::atan2((e - s).dot(frame.side), (e - s).dot(frame.low))};
}

std::optional<ArmAngles> solve_arm(const Body& body, const Pose& pose, Side side, const ArmTarget& target,
                                   const JointLimits& limits) {
  const auto i = static_cast<std::size_t>(side);
  const double upper = body.upper_arm_length[i];
  const double fore = body.forearm_length[i];
  const Eigen::Vector3d wrist = camera_from_chest(pose).inverse() * target.wrist;

  const ArmAngles before = arm_angles(pose, side);
  Eigen::Vector3d direction = -compose_zxy({before.abduct, before.flexion, before.twisting}).col(1);
  Eigen::Vector3d forearm = direction;
  // The clavicle moves the shoulder by a few centimetres: the way there may lead through places from which
  // the wrist is out of reach, so only the place where it ends decides. Plain steps may circle; half steps do
  // not.
  constexpr int kPlainSteps = 30;
  constexpr int kMostSteps = 120;
  constexpr double kSlack = 1e-6;  // m, of an arm that is just straight
  double beyond = 0.0;             // m out of reach
  const double cosine = std::cos(target.swivel);
  const double sine = std::sin(target.swivel);
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::Vector3d shoulder = shoulder_in_chest(body, side, direction);
    const Eigen::Vector3d line = wrist - shoulder;
    const double apart = line.norm();
    if (apart < 1e-6) {
      return std::nullopt;
    }
    const Eigen::Vector3d axis = line / apart;
    const double distance = std::clamp(apart, std::max(1e-6, std::abs(upper - fore)), upper + fore);
    beyond = std::abs(apart - distance);
    const double along = (upper * upper - fore * fore + distance * distance) / (2.0 * distance);
    const double across = std::sqrt(std::max(0.0, upper * upper - along * along));
    const SwivelFrame frame = swivel_frame(axis);
    const Eigen::Vector3d elbow = along * axis + across * (cosine * frame.low + sine * frame.side);
    const Eigen::Vector3d next = elbow.normalized();
    const double change = (next - direction).norm();
    direction = step < kPlainSteps ? next : (next + direction).normalized();
    forearm = (distance * axis - elbow).normalized();
    if (change < 1e-8) {
      break;
    }
  }
  if (beyond > kSlack) {
    return std::nullopt;
  }
  return angles_from_directions(direction, forearm, pose, side, limits);
}

ArmAngles arm_through(const Body& body, const Pose& pose, Side side, const Eigen::Vector3d& elbow,
                      const Eigen::Vector3d& wrist, const JointLimits& limits) {
  const Eigen::Isometry3d chest_from_camera = camera_from_chest(pose).inverse();
  const Eigen::Vector3d e = chest_from_camera * elbow;
  const Eigen::Vector3d w = chest_from_camera * wrist;
  Eigen::Vector3d direction = -Eigen::Vector3d::UnitY();
  for (int step = 0; step < 8; ++step) {
    direction = (e - shoulder_in_chest(body, side, direction)).normalized();
  }
  return angles_from_directions(direction, (w - e).normalized(), pose, side, limits);
}

}  // namespace telemime
