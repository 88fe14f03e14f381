// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/particle.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "telemime/body/rotations.h"

namespace telemime {

double effective_sample_size(std::span<const Particle> particles) {
  double squares = 0.0;
  for (const Particle& p : particles) {
    squares += p.weight * p.weight;
  }
  return squares > 0.0 ? 1.0 / squares : 0.0;
}

void weigh(std::span<Particle> particles) {
  double most = -std::numeric_limits<double>::infinity();
  for (const Particle& p : particles) {
    most = p.prior > 0.0 ? std::max(most, std::log(p.prior) + p.log_likelihood) : most;
  }
  double sum = 0.0;
  for (Particle& p : particles) {
    const double log_weight = std::log(p.prior) + p.log_likelihood - most;
    p.weight = std::isfinite(most) && p.prior > 0.0 ? std::exp(log_weight) : p.prior;
    sum += p.weight;
  }
  for (Particle& p : particles) {
    p.weight = sum > 0.0 ? p.weight / sum : 1.0 / static_cast<double>(particles.size());
  }
}

std::size_t heaviest(std::span<const Particle> particles) {
  const auto best =
      std::max_element(particles.begin(), particles.end(),
                       [](const Particle& a, const Particle& b) { return a.weight < b.weight; });
  return static_cast<std::size_t>(best - particles.begin());
}

Pose mean_pose(std::span<const Particle> particles) {
  PoseVector sum = PoseVector::Zero();
  // The trunk may turn all the way round: its angle is averaged about that of the heaviest.
  const double around = particles[heaviest(particles)].pose[Angle::root_torsion];
  double turn = 0.0;
  for (const Particle& p : particles) {
    sum += p.weight * p.pose.vector();
    turn += p.weight * wrap_angle(p.pose[Angle::root_torsion] - around);
  }
  Pose mean = Pose::from_vector(sum);
  mean[Angle::root_torsion] = wrap_angle(around + turn);
  return mean;
}

}  // namespace telemime
