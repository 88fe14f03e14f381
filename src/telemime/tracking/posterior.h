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

/// What a pose's spread depends on beside the particles.
struct SpreadContext {
  const Body& body;
  const Camera& camera;  ///< of the working image
  double region = 0.0;   ///< F of the estimate
  double size = 0.0;     ///< standard deviation of the person's size, as a share of it
};

/// Covariance of each joint about the estimate, seen from the middle of the shoulders: that of the particles,
/// and what the model does not know (SpreadModel).
PoseSpread spread_of(const SpreadContext& context, std::span<const Particle> particles, const Pose& estimate,
                     const SpreadModel& model);

/// The spread about another estimate: `spread` was found for one whose joints are `from`, the other one's are
/// `to` (m, camera frame). What lies between them is added.
PoseSpread about(PoseSpread spread, const JointPositions& from, const JointPositions& to);

/// The part of spread_of that does not come from particles. A joint outside the image is known to little
/// better than its bone's length.
std::array<Eigen::Matrix3d, kJointCount> model_covariance(const SpreadContext& context, const Pose& estimate,
                                                          const SpreadModel& model);

}  // namespace telemime
