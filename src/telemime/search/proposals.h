// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/core/random.h"
#include "telemime/search/objective.h"

namespace telemime {

/// Settings of the proposals: other poses of an arm or of the trunk that are evaluated in each frame, so that
/// a lost arm is found again. The table (settings_of) gives the meaning of each.
struct ProposalConfig {
  int directions = 38;
  int arms = 10;
  bool flips = true;
  bool upright = true;
  int kept = 4;
  int turns = 10;
  int refine = 80;
  double margin = 0.006;

  bool any_arms() const { return directions > 0 || arms > 0 || flips; }
  /// Most evaluations for one arm, not counting that of the present arm.
  int evaluations() const;
  /// The same, reduced in proportion to at most this many evaluations per arm; no proposals when that is too
  /// few.
  ProposalConfig within(int evaluations) const;
};

SettingTable settings_of(ProposalConfig& config);

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
