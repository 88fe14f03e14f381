// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/kinematic_flipping.h"

#include <algorithm>
#include <map>

#include "telemime/body/arm_flips.h"

namespace telemime {

void flip_best(const FilterContext& context, Generation& generation) {
  // The best particle of each family, that is of the children of one parent.
  std::map<int, std::size_t> best;
  for (std::size_t i = 0; i < generation.particles.size(); ++i) {
    const Particle& p = generation.particles[i];
    const auto [at, added] = best.try_emplace(p.parent, i);
    if (!added && p.log_likelihood > generation.particles[at->second].log_likelihood) {
      at->second = i;
    }
  }
  // The best families.
  std::vector<std::size_t> order;
  order.reserve(best.size());
  for (const auto& [parent, index] : best) {
    order.push_back(index);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return generation.particles[a].log_likelihood > generation.particles[b].log_likelihood;
  });
  order.resize(std::min(order.size(), static_cast<std::size_t>(context.config.flip_candidates)));
  // Its flips, each with the prior of one particle.
  const double share = 1.0 / context.config.particles;
  for (const std::size_t index : order) {
    const Particle from = generation.particles[index];
    for (const Pose& pose : kinematic_flips(context.model.body, from.pose, context.limits)) {
      Particle flipped;
      flipped.pose = pose;
      flipped.parent = from.parent;
      flipped.prior = share;
      flipped.origin = Origin::flipped;
      generation.particles.push_back(flipped);
    }
  }
}

}  // namespace telemime
