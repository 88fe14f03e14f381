// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/heuristic.h"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace telemime {

void run_searches(const FilterContext& context, Generation& generation) {
  std::vector<std::vector<Particle>> made(generation.searches.size());
  // The longest begin first, so that no thread waits long for the last.
  std::vector<std::size_t> order(made.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return generation.searches[a].evaluations > generation.searches[b].evaluations;
  });
  context.evaluators.each(order.size(), [&](std::size_t turn, Backend& backend) {
    made[order[turn]] = generation.searches[order[turn]].run(backend);
  });
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
