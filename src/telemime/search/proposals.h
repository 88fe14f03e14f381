// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/core/random.h"
#include "telemime/search/objective.h"

namespace telemime {

/// Proposals: other poses of an arm or of the trunk that are evaluated in each frame, so that a lost arm is
/// found again.
struct ProposalConfig {
  int directions = 38;  ///< directions of the forearm with the elbow as it is; 0: none
  int arms = 10;        ///< random arms; 0: none
  bool flips = true;    ///< whether mirror images of the arm in depth are proposed
  bool upright = true;  ///< whether a trunk half as bent and turned is proposed, before the arms
  int kept = 4;         ///< number of best proposals, apart from each other, that are searched further
  int turns = 10;       ///< evaluations with which each of those turns its forearm
  int refine = 80;      ///< evaluations for the whole arm of the best one; half as many for the present arm
  /// Least improvement of the cost, so that two arms that fit equally well do not alternate.
  double margin = 0.006;

  bool any_arms() const { return directions > 0 || arms > 0 || flips; }
  /// Most evaluations for one arm, not counting that of the present arm.
  int evaluations() const;
  /// The same, reduced in proportion to at most this many evaluations per arm; no proposals when that is too
  /// few.
  ProposalConfig within(int evaluations) const;
  /// Throws Error(config) that says what to change.
  void validate() const;
};

/// A configuration without proposals.
ProposalConfig no_proposals();

/// The pose, or one with the trunk half as bent and turned if that costs less; neck and wrists keep their
/// positions. A trunk that was tracked through a lean keeps some of it, because a plain shirt looks nearly
/// the same from every angle. Both candidates get a short search of the arms: `evaluations` + 2 in all.
Pose propose_upright(Objective& objective, const Pose& start, const ObjectiveWeights& weights,
                     double simplex_factor, int evaluations);

/// The best of the pose and its proposals, for both arms or for one chosen at random. A proposal replaces the
/// arm when it costs less by the margin after both had a short search: an arm that was tracked for many
/// frames fits closely even where it is wrong, a proposal does not even where it is right. The forearm's two
/// directions are searched first, because a lost arm has them wrong most often and two numbers converge
/// quickly. `simplex_factor` as in RegistrationConfig.
Pose propose_arms(Objective& objective, const Pose& start, const ObjectiveWeights& weights,
                  const ProposalConfig& config, bool both, double simplex_factor, Random& random);

}  // namespace telemime
