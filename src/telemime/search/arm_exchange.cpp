// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/arm_exchange.h"

#include <algorithm>

#include "telemime/body/arm_ik.h"
#include "telemime/body/arm_parts.h"
#include "telemime/search/blocks.h"

namespace telemime {

Pose with_arms_of(const Body& body, const Pose& pose, const Pose& left, const Pose& right,
                  const JointLimits& limits) {
  Pose to = pose;
  for (const Side side : {Side::left, Side::right}) {
    const Pose& from = side == Side::left ? left : right;
    to = with_wrist(body, to, side, arm_target(body, from, side), limits);
    for (const Angle angle : arm_parts(side).wrist_angles()) {
      to[angle] = from[angle];
    }
  }
  return to;
}

std::vector<Pose> distinct_arms(const Body& body, std::span<const Pose> poses, Side side, std::size_t most) {
  constexpr double kSame = 0.03;  // m
  const ArmParts& arm = arm_parts(side);
  std::vector<Pose> kept;
  std::vector<Eigen::Matrix<double, 3, 2>> places;
  for (std::size_t i = 0; i < poses.size() && kept.size() < most; ++i) {
    const JointPositions j = forward_kinematics(body, poses[i]).joints;
    Eigen::Matrix<double, 3, 2> here;
    here << j[arm.elbow], j[arm.wrist];
    if (std::none_of(places.begin(), places.end(),
                     [&](const auto& there) { return (here - there).colwise().norm().maxCoeff() < kSame; })) {
      kept.push_back(poses[i]);
      places.push_back(here);
    }
  }
  return kept;
}

}  // namespace telemime
