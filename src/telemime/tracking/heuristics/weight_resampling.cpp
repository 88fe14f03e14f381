// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/weight_resampling.h"

#include "telemime/tracking/resampling.h"

namespace telemime {

void resample_by_weight(const FilterContext& context, Generation& generation) {
  std::vector<double> weights;
  for (const Particle& p : generation.parents) {
    weights.push_back(p.weight);
  }
  generation.counts = proportional_counts(weights, context.config.particles);
  generation.keep_best = true;
}

}  // namespace telemime
