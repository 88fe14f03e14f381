// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "telemime/body/pose.h"
#include "telemime/likelihood/backend.h"

namespace telemime {

/// How a particle was made.
enum class Origin : std::uint8_t { start, kept, diffused, optimised, flipped, exchanged, elsewhere };

/// One hypothesis of the pose.
struct Particle {
  Pose pose;
  Pose before;                ///< of the parent, in the frame before; the same as `pose` at the start
  Score score;                ///< in the frame in which it was measured
  double log_likelihood = 0;  ///< see log_likelihood()
  double prior = 0;           ///< weight before the measurement; searches and flips add to a sum of 1
  double weight = 0;          ///< weight after it; the weights sum to 1
  int parent = 0;             ///< index into Generation::parents of its frame
  Origin origin = Origin::start;
  bool measured = false;  ///< whether score and log_likelihood are known
};

/// Effective number of particles: 1 / sum of squared weights; 0 without particles.
double effective_sample_size(std::span<const Particle> particles);

/// Sets the weights to prior x likelihood, normalised; to the priors when no likelihood is above zero.
void weigh(std::span<Particle> particles);

/// Index of the particle with the greatest weight; of equals the first. `particles` must not be empty.
std::size_t heaviest(std::span<const Particle> particles);

/// Weighted mean of the pose numbers; angles are averaged without wrapping. `particles` must not be empty.
Pose mean_pose(std::span<const Particle> particles);

}  // namespace telemime
