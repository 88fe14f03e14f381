// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/heuristic.h"

#include <algorithm>
#include <iterator>

namespace telemime {

void run_searches(const FilterContext& context, Generation& generation) {
  std::vector<std::vector<Particle>> made(generation.searches.size());
  context.evaluators.each(
      made.size(), [&](std::size_t i, Backend& backend) { made[i] = generation.searches[i].run(backend); });
  for (std::size_t i = 0; i < made.size(); ++i) {
    const Search& search = generation.searches[i];
    const int spent = search.evaluations > 0 ? search.evaluations : static_cast<int>(made[i].size());
    generation.evaluations += spent;
    if (search.family >= 0) {
      // After a simplex converged, the rest of its family is diffused.
      int& left = generation.counts[static_cast<std::size_t>(search.family)];
      left = std::max(0, left - spent);
    }
    std::move(made[i].begin(), made[i].end(), std::back_inserter(generation.particles));
  }
  generation.searches.clear();
}

}  // namespace telemime
