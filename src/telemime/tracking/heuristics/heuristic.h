// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string_view>
#include <vector>

#include "telemime/tracking/context.h"
#include "telemime/tracking/parts.h"

namespace telemime {

/// A local search that a heuristic asks for.
struct Search {
  std::function<std::vector<Particle>(Backend&)> run;  ///< the particles that it finds
  int evaluations = 0;                                 ///< that it spends; 0: one for each particle
  int family = -1;  ///< the parent whose children its evaluations replace; -1: they come on top
};

/// Particles of one frame while a step of the filter makes them.
struct Generation {
  std::vector<Particle> parents;  ///< those of the last frame; their weights sum to 1
  std::vector<int> counts;        ///< children of each parent that are still to be made
  bool keep_best = false;         ///< whether one child of the heaviest parent is not diffused
  PartSet moving = all_parts();   ///< parts that are diffused and searched
  bool end_effector = false;      ///< whether arms are diffused and searched in end-effector space
  std::vector<Search> searches;   ///< those that have not run yet
  std::vector<Particle> particles;
  int evaluations = 0;  ///< spent by local searches
};

/// Stages of a step at which heuristics run, in this order.
enum class Stage {
  merge,            ///< changes the parents
  resample,         ///< sets how many children each parent has (without one they are drawn at random)
  partition,        ///< sets what moves, and in which space
  optimise,         ///< asks for local searches; those of all heuristics then run side by side
  flip_candidates,  ///< adds particles to those that were made and measured
};

/// A heuristic of the filter (thesis 4.4.2), switched on and off by its name.
struct Heuristic {
  std::string_view name;
  Stage stage;
  void (*run)(const FilterContext& context, Generation& generation);
};

/// Runs the searches of a generation on all threads, those with the most `evaluations` first, and adds what
/// they find to its particles in the order in which they were asked for. The result does not depend on the
/// number of threads.
void run_searches(const FilterContext& context, Generation& generation);

}  // namespace telemime
