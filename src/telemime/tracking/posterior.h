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

/// A mode: particles whose elbows and wrists are near those of its best particle.
struct Mode {
  std::size_t best = 0;       ///< index of the heaviest particle
  std::size_t likeliest = 0;  ///< index of the particle with the greatest likelihood
  double weight = 0.0;        ///< sum over its particles
};

/// At most `most` modes, in the order of their best particles: the heaviest particle and all particles whose
/// elbows and wrists are within `radius` (m) of its own form the first mode; the next is formed from the
/// rest.
std::vector<Mode> find_modes(const Body& body, std::span<const Particle> particles, double radius,
                             std::size_t most);

/// What the spread of a pose depends on besides the particles.
struct SpreadContext {
  const Body& body;
  const Camera& camera;    ///< of the working image
  double region = 0.0;     ///< F of the estimate
  double size = 0.0;       ///< standard deviation of the person's size, as a share of it
  bool landmarks = false;  ///< whether the frame has landmarks, which hold the pose where regions do not fit
};

/// Covariance of each joint about the estimate, relative to the middle of the shoulders: that of the
/// particles plus that of the model (SpreadModel).
PoseSpread spread_of(const SpreadContext& context, std::span<const Particle> particles, const Pose& estimate,
                     const SpreadModel& model);

/// The spread about another estimate: `from` are the joints of the estimate that `spread` belongs to, `to`
/// those of the other one (m, camera frame). Their differences are added.
PoseSpread about(PoseSpread spread, const JointPositions& from, const JointPositions& to);

/// The part of spread_of that does not depend on particles. The uncertainty of a joint outside the image is
/// half the length of its bone.
std::array<Eigen::Matrix3d, kJointCount> model_covariance(const SpreadContext& context, const Pose& estimate,
                                                          const SpreadModel& model);

}  // namespace telemime
