// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/blocks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "telemime/body/arm_parts.h"
#include "telemime/body/rotations.h"

namespace telemime {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// Typical change from one frame to the next at 25 frames a second, by pose number: m, then rad in the order
// of Angle (conversational gestures: wrists move at 0.5 to 1 m/s).
constexpr std::array<double, kPoseSize> kTypicalChange = {
    0.008,       0.008,       0.015,       1.5 * kDegree, 1.5 * kDegree, 1.5 * kDegree,
    2 * kDegree, 2 * kDegree, 2 * kDegree, 5 * kDegree,   6 * kDegree,   5 * kDegree,
    5 * kDegree, 6 * kDegree, 5 * kDegree, 6 * kDegree,   6 * kDegree,   4 * kDegree,
    6 * kDegree, 4 * kDegree, 4 * kDegree, 6 * kDegree,   4 * kDegree};

double low_of(const JointLimits& limits, std::size_t i) {
  return i < 2 ? -kMostAsideSearched : i == 2 ? kNearestSearched : limits.min[i - 3];
}
double high_of(const JointLimits& limits, std::size_t i) {
  return i < 2 ? kMostAsideSearched : i == 2 ? kFarthestSearched : limits.max[i - 3];
}

SearchBlock numbers_block(const Pose& pose, const JointLimits& limits, double factor,
                          const std::vector<std::size_t>& which) {
  const auto n = static_cast<Eigen::Index>(which.size());
  SearchBlock block;
  block.start.resize(n);
  block.steps.resize(n);
  block.bounds = {Eigen::VectorXd(n), Eigen::VectorXd(n)};
  const PoseVector all = pose.vector();
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::size_t k = which[static_cast<std::size_t>(i)];
    block.start[i] = all[static_cast<Eigen::Index>(k)];
    block.steps[i] = factor * kTypicalChange[k];
    block.bounds.low[i] = low_of(limits, k);
    block.bounds.high[i] = high_of(limits, k);
  }
  block.decode = [all, which](const Eigen::VectorXd& x) {
    PoseVector v = all;
    for (std::size_t i = 0; i < which.size(); ++i) {
      v[static_cast<Eigen::Index>(which[i])] = x[static_cast<Eigen::Index>(i)];
    }
    return Pose::from_vector(v);
  };
  return block;
}

}  // namespace

SearchBlock whole_block(const Pose& pose, const JointLimits& limits, double factor) {
  std::vector<std::size_t> which(kPoseSize);
  for (std::size_t i = 0; i < kPoseSize; ++i) {
    which[i] = i;
  }
  return numbers_block(pose, limits, factor, which);
}

Pose with_wrist(const Body& body, const Pose& pose, Side side, const ArmTarget& target,
                const JointLimits& limits) {
  Pose moved = pose;
  if (const auto angles = solve_arm(body, pose, side, target, limits)) {
    set_arm_angles(moved, side, *angles);
    return moved;
  }
  const auto i = static_cast<std::size_t>(side);
  const Kinematics k = forward_kinematics(body, pose);
  const Eigen::Vector3d shoulder = k.joints[arm_parts(side).shoulder];
  const double longest = body.upper_arm_length[i] + body.forearm_length[i];
  const double shortest = std::abs(body.upper_arm_length[i] - body.forearm_length[i]);
  const Eigen::Vector3d line = target.wrist - shoulder;
  const double distance = std::max(1e-6, line.norm());
  // The shoulder moves with the arm, so one step does not always do.
  constexpr std::array kSlack = {0.002, 0.02, 0.06, 0.12};  // m to the shortest, share of the longest reach
  for (const double slack : kSlack) {
    const double wanted = std::clamp(distance, shortest + slack, longest * (1.0 - slack));
    const ArmTarget nearer = {shoulder + line * (wanted / distance), target.swivel};
    if (const auto angles = solve_arm(body, pose, side, nearer, limits)) {
      set_arm_angles(moved, side, *angles);
      return moved;
    }
  }
  return moved;
}

SearchBlock trunk_block(const Body& body, const Pose& pose, const JointLimits& limits, double factor) {
  SearchBlock block = numbers_block(pose, limits, factor, {0, 1, 2, 3, 4, 5, 6, 7, 8});
  block.decode = [&body, &limits, move = block.decode, left = arm_target(body, pose, Side::left),
                  right = arm_target(body, pose, Side::right)](const Eigen::VectorXd& x) {
    const Pose moved = with_wrist(body, move(x), Side::left, left, limits);
    return with_wrist(body, moved, Side::right, right, limits);
  };
  return block;
}

namespace {

// A block of 7 numbers whose last three are the hand's angles; the first four are the caller's.
SearchBlock with_hand(const Pose& pose, Side side, const JointLimits& limits, double factor) {
  SearchBlock block;
  block.start.resize(7);
  block.steps.resize(7);
  block.bounds = {Eigen::VectorXd(7), Eigen::VectorXd(7)};
  const std::array<Angle, 3> angles = arm_parts(side).wrist_angles();
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(4 + i);
    const Angle angle = angles[i];
    const auto a = static_cast<std::size_t>(angle);
    block.start[at] = pose[angle];
    block.steps[at] = factor * kTypicalChange[3 + a];
    block.bounds.low[at] = limits.min[a];
    block.bounds.high[at] = limits.max[a];
  }
  return block;
}

void set_hand(Pose& pose, Side side, const Eigen::VectorXd& x) {
  const std::array<Angle, 3> angles = arm_parts(side).wrist_angles();
  for (std::size_t i = 0; i < angles.size(); ++i) {
    pose[angles[i]] = x[static_cast<Eigen::Index>(4 + i)];
  }
}

// Turns a direction within the image plane (about z) and out of it (about the axis in the plane across it).
Eigen::Vector3d turned(const Eigen::Vector3d& direction, double in_plane, double in_depth) {
  const Eigen::Vector3d flat = rotation_z(in_plane) * direction;
  Eigen::Vector3d across(-flat.y(), flat.x(), 0.0);
  if (across.norm() < 1e-6) {
    across = Eigen::Vector3d::UnitX();
  }
  return Eigen::AngleAxisd(in_depth, across.normalized()) * flat;
}

}  // namespace

SearchBlock bones_block(const Body& body, const Pose& pose, Side side, const JointLimits& limits,
                        double factor) {
  const ArmParts& arm = arm_parts(side);
  const auto i = static_cast<std::size_t>(side);
  const Kinematics k = forward_kinematics(body, pose);
  const Eigen::Vector3d shoulder = k.joints[arm.shoulder];
  const Eigen::Vector3d elbow = k.joints[arm.elbow];
  const Eigen::Vector3d wrist = k.joints[arm.wrist];
  const Eigen::Vector3d upper = elbow - shoulder;
  const Eigen::Vector3d fore = wrist - elbow;
  SearchBlock block = with_hand(pose, side, limits, factor);
  constexpr double kMost = 1.2;       // rad, of a bone from its start
  constexpr double kUpperTurn = 4.0;  // degrees: typical turns of the upper arm from frame to frame,
  constexpr double kUpperLift = 6.0;  // across and along its plane,
  constexpr double kForeTurn = 6.0;   // and of the forearm
  constexpr double kForeLift = 9.0;
  block.start.head<4>().setZero();
  block.steps.head<4>() << factor * kUpperTurn * kDegree, factor * kUpperLift * kDegree,
      factor * kForeTurn * kDegree, factor * kForeLift * kDegree;
  block.bounds.low.head<4>().setConstant(-kMost);
  block.bounds.high.head<4>().setConstant(kMost);
  block.decode = [&body, pose, side, &limits, shoulder, upper, fore,
                  fore_length = body.forearm_length[i]](const Eigen::VectorXd& x) {
    const Eigen::Vector3d new_elbow = shoulder + turned(upper, x[0], x[1]);
    const Eigen::Vector3d new_wrist = new_elbow + turned(fore, x[2], x[3]).normalized() * fore_length;
    Pose moved = pose;
    set_arm_angles(moved, side, arm_through(body, pose, side, new_elbow, new_wrist, limits));
    set_hand(moved, side, x);
    return moved;
  };
  return block;
}

SearchBlock part_of(const SearchBlock& block, Eigen::Index first, Eigen::Index count) {
  SearchBlock part;
  part.start = block.start.segment(first, count);
  part.steps = block.steps.segment(first, count);
  part.bounds = {block.bounds.low.segment(first, count), block.bounds.high.segment(first, count)};
  part.decode = [first, count, all = block.start, decode = block.decode](const Eigen::VectorXd& x) {
    Eigen::VectorXd numbers = all;
    numbers.segment(first, count) = x;
    return decode(numbers);
  };
  return part;
}

SearchBlock arm_block(const Body& body, const Pose& pose, Side side, const JointLimits& limits,
                      double factor) {
  const ArmTarget target = arm_target(body, pose, side);
  SearchBlock block = with_hand(pose, side, limits, factor);
  constexpr double kNearestWrist = 0.02;  // m: one that reaches for the camera stays on its viewing ray
  const double z = std::max(kNearestWrist, target.wrist.z());
  constexpr double kAcross = 0.025;  // m, typical change of a wrist from frame to frame
  constexpr double kAlong = 0.030;
  constexpr double kSwivel = 8.0;  // degrees
  block.start.head<4>() << target.wrist.x() / z, target.wrist.y() / z, z, target.swivel;
  block.steps.head<4>() << factor * kAcross / z, factor * kAcross / z, factor * kAlong,
      factor * kSwivel * kDegree;
  block.bounds.low.head<4>() << -4.0, -4.0, std::min(kNearestSearched, z), target.swivel - std::numbers::pi;
  block.bounds.high.head<4>() << 4.0, 4.0, kFarthestSearched, target.swivel + std::numbers::pi;
  block.decode = [&body, pose, side, &limits](const Eigen::VectorXd& x) {
    return with_arm(body, pose, side, x, limits);
  };
  return block;
}

Pose with_arm(const Body& body, const Pose& pose, Side side, const Eigen::VectorXd& point,
              const JointLimits& limits) {
  const ArmTarget wanted = {Eigen::Vector3d(point[0] * point[2], point[1] * point[2], point[2]),
                            wrap_angle(point[3])};
  Pose moved = with_wrist(body, pose, side, wanted, limits);
  set_hand(moved, side, point);
  return moved;
}

}  // namespace telemime
