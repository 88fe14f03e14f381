// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/modes.h"

#include <cmath>

#include "telemime/tracking/posterior.h"

namespace telemime {

void merge_modes(const FilterContext& context, Generation& generation) {
  std::vector<Particle> merged;
  double sum = 0.0;
  for (const Mode& mode : find_modes(context.model.body, generation.parents, context.config.mode_radius,
                                     static_cast<std::size_t>(context.config.modes))) {
    Particle particle = generation.parents[mode.likeliest];
    particle.weight = std::pow(mode.weight, context.config.memory);
    sum += particle.weight;
    merged.push_back(particle);
  }
  for (Particle& p : merged) {
    p.weight /= sum;
  }
  generation.parents = std::move(merged);
}

}  // namespace telemime
