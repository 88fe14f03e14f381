// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/arm_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "telemime/body/arm_parts.h"
#include "telemime/body/interpenetration.h"

namespace telemime {
namespace {

constexpr int kMostAttempts = 20;  // to draw an arm inside the limits that does not touch the body
// How far outside the joint limits (rad) an arm may be before it is clamped to them.
constexpr double kRandomSlack = 0.05;
constexpr double kFanSlack = 0.15;  // clamped by this much, a forearm still points near the wanted direction
constexpr double kBehind = 0.25;    // directions of the fan that point backward, of the unit sphere's radius

}  // namespace

Pose random_arm(const Body& body, const Pose& pose, Side side, const JointLimits& limits, Random& random) {
  const auto i = static_cast<std::size_t>(side);
  const double outward = side == Side::left ? 1.0 : -1.0;
  Pose rest = pose;
  set_arm_angles(rest, side, {0.0, 0.0, 0.0, 0.0});
  const Kinematics k = forward_kinematics(body, rest);
  const Eigen::Vector3d shoulder = k.joints[arm_parts(side).shoulder];
  const Eigen::Matrix3d& chest = k[Segment::chest].linear();
  Pose arm = rest;
  for (int attempt = 0; attempt < kMostAttempts; ++attempt) {
    // In the chest's frame: x outward, y up, z forward. Densest where arms hang or gesture in front.
    const Eigen::Vector3d upper = Eigen::Vector3d(outward * random.normal(0.45, 0.5),
                                                  random.normal(-0.55, 0.6), random.normal(0.2, 0.45))
                                      .normalized();
    const Eigen::Vector3d fore =
        Eigen::Vector3d(outward * random.normal(0.1, 0.7), random.normal(0.0, 0.7), random.normal(0.45, 0.5))
            .normalized();
    const Eigen::Vector3d elbow = shoulder + chest * upper * body.upper_arm_length[i];
    const Eigen::Vector3d wrist = elbow + chest * fore * body.forearm_length[i];
    set_arm_angles(arm, side, arm_through(body, rest, side, elbow, wrist, limits));
    if (limits.contains(arm, kRandomSlack) &&
        interpenetration(body, forward_kinematics(body, arm)) < kInvalidInterpenetration) {
      break;
    }
  }
  return limits.clamp(arm);
}

std::vector<Pose> forearm_fan(const Body& body, const Pose& pose, Side side, const JointLimits& limits,
                              int count, Random& random) {
  const ArmParts& parts = arm_parts(side);
  const Kinematics k = forward_kinematics(body, pose);
  const Eigen::Vector3d& elbow = k.joints[parts.elbow];
  const Eigen::Matrix3d& chest = k[Segment::chest].linear();
  Pose straight = pose;
  straight[parts.wrist_flexion] = 0.0;
  straight[parts.wrist_pivot] = 0.0;
  constexpr double kGoldenAngle = 2.0 * std::numbers::pi * (2.0 - std::numbers::phi);
  const double turn = random.uniform(0.0, 2.0 * std::numbers::pi);
  const double shift = random.uniform();
  std::vector<Pose> fan;
  for (int i = 0; i < count; ++i) {
    const double forward = 1.0 - (1.0 + kBehind) * (i + shift) / count;
    const double aside = std::sqrt(std::max(0.0, 1.0 - forward * forward));
    const double angle = turn + i * kGoldenAngle;
    const Eigen::Vector3d fore(aside * std::cos(angle), aside * std::sin(angle), forward);
    const Eigen::Vector3d wrist = elbow + chest * fore * body.forearm_length[static_cast<std::size_t>(side)];
    Pose arm = straight;
    set_arm_angles(arm, side, arm_through(body, straight, side, elbow, wrist, limits));
    if (limits.contains(arm, kFanSlack)) {
      arm = limits.clamp(arm);
      if (interpenetration(body, forward_kinematics(body, arm)) < kInvalidInterpenetration) {
        fan.push_back(arm);
      }
    }
  }
  return fan;
}

ScoredPose search_block(Objective& objective, const ScoredPose& from, const SearchBlock& block,
                        const ObjectiveWeights& weights, int evaluations) {
  SimplexOptions options;
  options.max_evaluations = evaluations;
  const SimplexResult found =
      minimise([&](const Eigen::VectorXd& x) { return objective(block.decode(x), weights); },
               axis_simplex(block.start, block.steps, block.bounds), block.bounds, options);
  return found.best().cost < from.cost ? ScoredPose{block.decode(found.best().point), found.best().cost}
                                       : from;
}

Pose search_arm(Objective& objective, const Pose& pose, Side side, const ObjectiveWeights& weights,
                const ArmSearchConfig& config, Random& random) {
  const Body& body = objective.model().body;
  std::vector<ScoredPose> candidates = {{pose, objective(pose, weights)}};
  for (int i = 0; i < config.samples; ++i) {
    const Pose arm = random_arm(body, pose, side, objective.limits(), random);
    candidates.push_back({arm, objective(arm, weights)});
  }
  const auto kept = std::min(candidates.size(), static_cast<std::size_t>(std::max(1, config.kept)));
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const ScoredPose& a, const ScoredPose& b) { return a.cost < b.cost; });
  ScoredPose best = candidates.front();
  for (std::size_t i = 0; i < kept; ++i) {
    const SearchBlock block = arm_block(body, candidates[i].pose, side, objective.limits(), 3.0);
    best = search_block(objective, best, block, weights, config.refine);
  }
  return best.pose;
}

}  // namespace telemime
