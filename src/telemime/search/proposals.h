// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/core/random.h"
#include "telemime/search/objective.h"

namespace telemime {

/// Arms from elsewhere that are tried in each frame, for each arm, so that one that was lost comes back.
struct ProposalConfig {
  int directions = 38;  ///< of the forearm, about the elbow as it is; 0: none
  int arms = 10;        ///< random ones; 0: none
  bool flips = true;    ///< the arm's mirror images in depth
  bool upright = true;  ///< the trunk half as bent and turned, before the arms have their turn
  int kept = 4;         ///< best ones, unlike each other, that are searched further
  int turns = 10;       ///< evaluations for each of those to turn its forearm
  int refine = 80;  ///< evaluations for the whole arm of the best of those; half as many for the arm itself
  /// A proposal must be better by so much: two arms that fit equally well must not take turns.
  double margin = 0.006;

  bool any_arms() const { return directions > 0 || arms > 0 || flips; }
  /// Evaluations for one arm, at most; without that of the arm as it is.
  int evaluations() const;
  /// The same in proportion for at most so many evaluations an arm; too few for a search: none.
  ProposalConfig within(int evaluations) const;
  /// Throws Error(config) with what to change.
  void validate() const;
};

/// Neither arms from elsewhere nor an upright trunk.
ProposalConfig no_proposals();

/// The pose, or one with the trunk half as bent and turned where that costs less; neck and wrists stay where
/// they are. A trunk that was followed through a lean keeps some of it: a plain shirt looks nearly the same
/// from within. Both get a short search of the arms, `evaluations` in all and two more.
Pose propose_upright(Objective& objective, const Pose& start, const ObjectiveWeights& weights,
                     double simplex_factor, int evaluations);

/// The best of the pose and its arms from elsewhere; of both arms, or of one at random. A proposal replaces
/// the arm when its cost is lower by the margin after both had a short search: an arm that was followed for
/// many frames fits closely even where it is wrong, one from elsewhere does not even where it is right. The
/// forearm's two directions are searched first: they are what a lost arm has wrong most often, and two
/// numbers converge in few evaluations. `simplex_factor` as in RegistrationConfig. Same generator, same pose.
Pose propose_arms(Objective& objective, const Pose& start, const ObjectiveWeights& weights,
                  const ProposalConfig& config, bool both, double simplex_factor, Random& random);

}  // namespace telemime
