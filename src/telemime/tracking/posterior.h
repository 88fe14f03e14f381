// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <vector>

#include "telemime/body/body.h"
#include "telemime/body/motion_frame.h"
#include "telemime/tracking/filter_model.h"
#include "telemime/tracking/particle.h"

namespace telemime {

/// Particles whose elbows and wrists are near those of the best one.
struct Mode {
  std::size_t best = 0;       ///< index of the heaviest particle
  std::size_t likeliest = 0;  ///< of the one with the greatest likelihood
  double weight = 0.0;        ///< of all its particles
};

/// The modes in the order of their best particles, at most `most`: the heaviest particle founds one, and
/// takes in all particles whose elbows and wrists are within `radius` (m) of its own; then the heaviest of
/// the rest.
std::vector<Mode> find_modes(const Body& body, std::span<const Particle> particles, double radius,
                             std::size_t most);

/// Covariance of each joint about the estimate, seen from the middle of the shoulders: that of the particles,
/// and what the model does not know (SpreadModel). `size` is the standard deviation of the person's size as a
/// share of it.
PoseSpread spread_of(const Body& body, std::span<const Particle> particles, const Pose& estimate,
                     const SpreadModel& model, double size);

/// The part of spread_of that does not come from particles.
std::array<Eigen::Matrix3d, kJointCount> model_covariance(const Body& body, const Pose& estimate,
                                                          const SpreadModel& model, double size);

}  // namespace telemime
