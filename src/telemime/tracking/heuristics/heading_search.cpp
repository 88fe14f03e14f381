// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/heading_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "telemime/search/shape_refine.h"

namespace telemime {
namespace {

struct Trunk {
  double torsion = 0.0;
  double roll = 0.0;
  double tilt = 0.0;
  double farther = 1.0;  // factor of the neck's distance along its viewing ray
  int evaluations = 0;
};

Pose turned(const Body& body, const Pose& pose, const Trunk& trunk, const JointLimits& limits) {
  const auto neck = [&](const Pose& p) { return forward_kinematics(body, p).joints[Joint::neck]; };
  Pose to = pose;
  to[Angle::root_torsion] = trunk.torsion;
  to[Angle::root_roll] = trunk.roll;
  to[Angle::root_tilt] = trunk.tilt;
  to = limits.clamp(to);
  to.root += trunk.farther * neck(pose) - neck(to);
  return to;
}

std::vector<Trunk> trunks_to_try(const FilterContext& context, const Pose& from, Random& random) {
  constexpr double kBent = 0.1;      // rad; the local search corrects smaller angles
  constexpr double kNew = 0.2;       // rad, a turn that the local search would not find
  constexpr double kFarthest = 1.0;  // rad
  constexpr double kInFront = 0.1;   // m
  const Trunk now = {
      .torsion = from[Angle::root_torsion], .roll = from[Angle::root_roll], .tilt = from[Angle::root_tilt]};
  const int usual = context.config.turn_evaluations;
  const int thorough =
      std::max(usual, std::min(context.config.walk_evaluations, context.config.particles / 2));
  std::vector<Trunk> trunks;
  if (std::max({std::abs(now.torsion - context.heading), std::abs(now.roll), std::abs(now.tilt)}) > kBent) {
    const bool far = std::abs(now.torsion - context.heading) > kNew;
    trunks.push_back({.torsion = context.heading, .evaluations = far ? thorough : usual});
  }
  if (std::abs(now.tilt) > kNew) {
    // A leaning trunk looks much like an upright one at the distance of its lower end.
    const double neck = forward_kinematics(context.model.body, from).joints[Joint::neck].z();
    if (std::min(neck, from.root.z()) > kInFront) {
      trunks.push_back(
          {.torsion = context.heading, .farther = from.root.z() / neck, .evaluations = thorough});
    }
  }
  if (random.uniform() < 0.5) {
    const double way = random.uniform(kNew, kFarthest);
    const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
    trunks.push_back(
        {.torsion = now.torsion + side * way, .roll = now.roll, .tilt = now.tilt, .evaluations = usual});
  }
  return trunks;
}

constexpr int kStarts = 2;  // evaluated before each search

// The pose with this trunk, searched from there.
Particle search_turned(const FilterContext& context, const Pose& from, const Trunk& trunk, std::size_t index,
                       int parent, Backend& backend) {
  const Body& body = context.model.body;
  Objective objective(backend, context.frame, context.model, context.limits,
                      Prior{.heading = context.heading});
  RegistrationConfig search = context.search;
  search.iterations = trunk.evaluations;
  search.proposals = no_proposals();
  Random random = context.random(purpose::kHeadingSearch, 1 + index);
  Pose start = turned(body, from, trunk, context.limits);
  // The arms turn with the trunk, or stay where they are in the image.
  const Pose seen = carry_arms(body, from, body, start, context.limits);
  if (objective(seen, search.region) < objective(start, search.region)) {
    start = seen;
  }
  const RegistrationResult found = register_pose(objective, start, search, random);
  Particle particle;
  particle.pose = found.pose;
  particle.parent = parent;
  particle.prior = static_cast<double>(search.iterations) / context.config.particles;
  particle.origin = Origin::elsewhere;
  return particle;
}

}  // namespace

void search_heading(const FilterContext& context, Generation& generation) {
  // Landmarks show which way the trunk faces; their own proposals cover its turns.
  if (context.frame.landmarks) {
    return;
  }
  const std::size_t best = heaviest(generation.parents);
  const Pose& from = generation.parents[best].pose;
  Random random = context.random(purpose::kHeadingSearch);
  const std::vector<Trunk> trunks = trunks_to_try(context, from, random);
  for (std::size_t i = 0; i < trunks.size(); ++i) {
    generation.searches.push_back(
        {.run = [&context, from, best, i, trunk = trunks[i]](Backend& backend) -> std::vector<Particle> {
           return {search_turned(context, from, trunk, i, static_cast<int>(best), backend)};
         },
         .evaluations = trunks[i].evaluations + kStarts});
  }
}

}  // namespace telemime
