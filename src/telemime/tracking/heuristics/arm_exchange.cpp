// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/arm_exchange.h"

#include <algorithm>
#include <vector>

#include "telemime/search/arm_exchange.h"

namespace telemime {
namespace {

constexpr std::size_t kArms = 3;       // of each side
constexpr std::size_t kLookedAt = 60;  // particles, the likeliest first

}  // namespace

void exchange_best_arms(const FilterContext& context, Generation& generation) {
  // Without landmarks the filter is the one that the tables of the thesis were measured with.
  if (!context.frame.landmarks) {
    return;
  }
  // The likeliest particles.
  std::vector<const Particle*> order;
  for (const Particle& particle : generation.particles) {
    if (particle.measured) {
      order.push_back(&particle);
    }
  }
  std::stable_sort(order.begin(), order.end(), [](const Particle* a, const Particle* b) {
    return a->log_likelihood > b->log_likelihood;
  });
  order.resize(std::min(order.size(), kLookedAt));
  if (order.empty()) {
    return;
  }
  std::vector<Pose> poses;
  for (const Particle* particle : order) {
    poses.push_back(particle->pose);
  }
  // Every left arm with every right arm on the trunk of the likeliest, but for the pair that it has.
  const Body& body = context.model.body;
  const std::vector<Pose> left = distinct_arms(body, poses, Side::left, kArms);
  const std::vector<Pose> right = distinct_arms(body, poses, Side::right, kArms);
  Particle made;
  made.parent = order.front()->parent;
  made.prior = 1.0 / context.config.particles;
  made.origin = Origin::exchanged;
  for (std::size_t i = 1; i < left.size() * right.size(); ++i) {
    made.pose =
        with_arms_of(body, poses.front(), left[i / right.size()], right[i % right.size()], context.limits);
    generation.particles.push_back(made);
  }
}

}  // namespace telemime
