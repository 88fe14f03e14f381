// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "telemime/tracking/particle.h"
#include "telemime/tracking/parts.h"

namespace telemime {

/// One frame's particles while they come into being.
struct Generation {
  std::vector<Particle> parents;  ///< the last frame's; weights sum to 1
  std::vector<int> counts;        ///< children of each parent that are still to be made
  bool keep_best = false;         ///< one child of the heaviest parent is not diffused
  PartSet moving = all_parts();   ///< what is diffused and searched
  bool end_effector = false;      ///< in which space
  std::vector<Particle> particles;
  int evaluations = 0;  ///< spent by local searches
};

}  // namespace telemime
