// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/posterior.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace telemime {
namespace {

using ArmPoints = Eigen::Matrix<double, 3, 4>;

ArmPoints arm_points(const Body& body, const Pose& pose) {
  const JointPositions j = forward_kinematics(body, pose).joints;
  ArmPoints points;
  points << j[Joint::l_elbow], j[Joint::l_wrist], j[Joint::r_elbow], j[Joint::r_wrist];
  return points;
}

}  // namespace

std::vector<Mode> find_modes(const Body& body, std::span<const Particle> particles, double radius,
                             std::size_t most) {
  // What weighs next to nothing makes no mode.
  constexpr double kLeast = 1e-9;
  std::vector<std::size_t> order(particles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return particles[a].weight > particles[b].weight; });
  std::vector<Mode> modes;
  std::vector<ArmPoints> places;
  for (const std::size_t i : order) {
    if (particles[i].weight < kLeast && !modes.empty()) {
      break;
    }
    const ArmPoints here = arm_points(body, particles[i].pose);
    bool taken = false;
    for (std::size_t m = 0; m < modes.size() && !taken; ++m) {
      taken = (here - places[m]).colwise().norm().maxCoeff() <= radius;
      modes[m].weight += taken ? particles[i].weight : 0.0;
    }
    if (!taken && modes.size() < most) {
      modes.push_back({i, particles[i].weight});
      places.push_back(here);
    }
  }
  return modes;
}

}  // namespace telemime
