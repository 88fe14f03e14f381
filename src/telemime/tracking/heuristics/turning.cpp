// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/turning.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "telemime/tracking/purposes.h"

namespace telemime {
namespace {

struct Trunk {
  double torsion = 0.0;
  double roll = 0.0;
  double tilt = 0.0;
};

Pose turned(const Body& body, const Pose& pose, const Trunk& trunk, const JointLimits& limits) {
  const auto neck = [&](const Pose& p) { return forward_kinematics(body, p).joints[Joint::neck]; };
  Pose to = pose;
  to[Angle::root_torsion] = trunk.torsion;
  to[Angle::root_roll] = trunk.roll;
  to[Angle::root_tilt] = trunk.tilt;
  to = limits.clamp(to);
  to.root += neck(pose) - neck(to);
  return to;
}

}  // namespace

void turn_trunk(const FilterContext& context, Generation& generation) {
  constexpr double kBent = 0.1;      // rad; the local search straightens what is less
  constexpr double kNew = 0.2;       // rad, a turn that the local search would not find
  constexpr double kFarthest = 1.0;  // rad
  const Pose& from = generation.parents[heaviest(generation.parents)].pose;
  const Trunk now = {from[Angle::root_torsion], from[Angle::root_roll], from[Angle::root_tilt]};
  Random random = context.random(purpose::kTurning);
  std::vector<Trunk> trunks;
  if (std::max({std::abs(now.torsion - context.facing), std::abs(now.roll), std::abs(now.tilt)}) > kBent) {
    trunks.push_back({context.facing, 0.0, 0.0});
  }
  if (random.uniform() < 0.5) {
    const double way = random.uniform(kNew, kFarthest);
    const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
    trunks.push_back({now.torsion + side * way, now.roll, now.tilt});
  }
  std::vector<Particle> made(trunks.size());
  context.evaluators.each(trunks.size(), [&](std::size_t i, Backend& backend) {
    Objective objective(backend, context.frame, context.model, context.limits);
    objective.face(context.facing);
    RegistrationConfig search = context.search;
    search.iterations = context.config.turn_evaluations;
    search.proposals = no_proposals();
    Random own = context.random(purpose::kTurning, 1 + i);
    const RegistrationResult found =
        register_pose(objective, turned(context.model.body, from, trunks[i], context.limits), search, own);
    Particle& particle = made[i];
    particle.pose = found.pose;
    particle.parent = static_cast<int>(heaviest(generation.parents));
    particle.prior = static_cast<double>(search.iterations) / context.config.particles;
    particle.origin = Origin::elsewhere;
  });
  for (const Particle& particle : made) {
    generation.particles.push_back(particle);
    generation.evaluations += context.config.turn_evaluations;
  }
}

}  // namespace telemime
