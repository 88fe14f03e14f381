// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

#include "telemime/tracking/context.h"
#include "telemime/tracking/generation.h"

namespace telemime {

/// When a heuristic has its turn in a frame, in this order.
enum class Stage {
  merge,            ///< changes the parents
  resample,         ///< sets how many children each parent has (else drawn at random)
  partition,        ///< sets what moves, and in which space
  optimise,         ///< makes children by local search
  flip_candidates,  ///< adds particles to those that were made and measured
};

/// What a heuristic does to the posterior.
enum class Kind {
  resampling,  ///< changes who survives, not where particles may be
  proposal,    ///< changes where particles are drawn from
  candidates,  ///< adds particles from a deterministic rule, with a density that is not known
};

/// A heuristic of the filter (thesis 4.4.2): switched on and off by its name.
struct Heuristic {
  std::string_view name;
  std::string_view what;  ///< for help and documents
  std::string_view source;
  Stage stage;
  Kind kind;
  void (*run)(const FilterContext& context, Generation& generation);
};

}  // namespace telemime
