// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "telemime/body/body.h"
#include "telemime/tracking/particle.h"

namespace telemime {

/// Particles whose elbows and wrists are near those of the best one.
struct Mode {
  std::size_t best = 0;  ///< index of the heaviest particle
  double weight = 0.0;   ///< of all its particles
};

/// The modes in the order of their best particles, at most `most`: the heaviest particle founds one, and
/// takes in all particles whose elbows and wrists are within `radius` (m) of its own; then the heaviest of
/// the rest.
std::vector<Mode> find_modes(const Body& body, std::span<const Particle> particles, double radius,
                             std::size_t most);

}  // namespace telemime
