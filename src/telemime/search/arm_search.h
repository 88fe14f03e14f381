// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "telemime/core/random.h"
#include "telemime/search/objective.h"

namespace telemime {

struct ArmSearchConfig {
  int samples = 400;  ///< random arms that are tried
  int kept = 4;       ///< best ones that are refined
  int refine = 60;    ///< evaluations of each refinement
};

/// A random arm inside the limits that does not enter the body: direction of the upper arm, bend of the elbow
/// and swivel drawn so that hands before the body are likelier than behind it.
Pose random_arm(const Body& body, const Pose& pose, Side side, const JointLimits& limits, Random& random);

/// The same arm with other forearms: the elbow stays (but for some centimetres where
/// limits clamp), the hand is straight, and the forearm points in
/// directions spread evenly (a Fibonacci lattice, turned at random) over all that lies before the chest and a
/// little behind. Those outside the limits or inside the body are left out: at most `count` poses.
std::vector<Pose> forearm_fan(const Body& body, const Pose& pose, Side side, const JointLimits& limits,
                              int count, Random& random);

/// Looks for one arm everywhere, not only near where it was: random arms, the best refined by a simplex.
/// Never worse than the arm that came in. For the first frame and for recovery.
Pose search_arm(Objective& objective, const Pose& pose, Side side, const ObjectiveWeights& weights,
                const ArmSearchConfig& config, Random& random);

}  // namespace telemime
