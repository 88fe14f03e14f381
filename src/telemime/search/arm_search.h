// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "telemime/core/random.h"
#include "telemime/search/blocks.h"
#include "telemime/search/objective.h"

namespace telemime {

/// Settings of search_arm; part of the table of CalibrationConfig.
struct ArmSearchConfig {
  int samples = 400;
  int kept = 4;
  int refine = 60;
};

/// A random arm inside the limits and outside the body. Directions of upper arm and forearm are drawn so that
/// hands in front of the body are likelier than behind it.
Pose random_arm(const Body& body, const Pose& pose, Side side, const JointLimits& limits, Random& random);

/// The same arm with other forearms: the elbow stays (up to some centimetres where limits clamp), the hand is
/// straight, and the forearms point in evenly spread directions (a Fibonacci lattice, rotated at random) in
/// front of the chest and a little behind it. At most `count` poses: those outside the limits or inside the
/// body are dropped.
std::vector<Pose> forearm_fan(const Body& body, const Pose& pose, Side side, const JointLimits& limits,
                              int count, Random& random);

/// The best pose that a simplex finds in a block if it costs less than `from`, otherwise `from`. Spends at
/// most `evaluations`, but at least one.
ScoredPose search_block(Objective& objective, const ScoredPose& from, const SearchBlock& block,
                        const ObjectiveWeights& weights, int evaluations);

/// Searches one arm globally, for the first frame and for recovery: random arms, of which the best are
/// refined by a simplex. Never costs more than the arm of `pose`.
Pose search_arm(Objective& objective, const Pose& pose, Side side, const ObjectiveWeights& weights,
                const ArmSearchConfig& config, Random& random);

}  // namespace telemime
