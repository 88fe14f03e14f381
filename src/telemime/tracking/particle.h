// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "telemime/body/pose.h"
#include "telemime/likelihood/backend.h"

namespace telemime {

/// Where a particle comes from.
enum class Origin : std::uint8_t { start, kept, diffused, optimised, flipped, elsewhere };

/// One hypothesis about the pose.
struct Particle {
  Pose pose;
  Score score;                ///< F and D_C in the frame that it was measured in
  double log_likelihood = 0;  ///< of equation 4.12, what is known without the image included
  double prior = 0;           ///< share before the measurement; searches and flips come on top of a sum of 1
  double weight = 0;          ///< share after it; the sum is 1
  int parent = -1;            ///< index in Generation::parents of its frame; -1: none
  Origin origin = Origin::start;
  bool measured = false;  ///< score and log_likelihood belong to the frame
};

/// 1 / sum of squared weights: how many particles carry the estimate; 0 when there are none.
double effective_sample_size(std::span<const Particle> particles);

/// weight ~ prior x likelihood, normalised. When no particle has a likelihood above zero, the priors stay.
void weigh(std::span<Particle> particles);

/// Index of the particle with the greatest weight, the first of equals. `particles` must not be empty.
std::size_t heaviest(std::span<const Particle> particles);

/// Weighted mean of the pose numbers; angles are averaged as they are. `particles` must not be empty.
Pose mean_pose(std::span<const Particle> particles);

}  // namespace telemime
