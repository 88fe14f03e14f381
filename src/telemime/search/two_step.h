// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "telemime/core/random.h"
#include "telemime/search/blocks.h"
#include "telemime/search/objective.h"
#include "telemime/search/proposals.h"

namespace telemime {

enum class Method { regions, edges, two_step };

struct RegistrationConfig {
  Method method = Method::two_step;
  /// Cost evaluations a frame, both steps together.
  int iterations = 2000;
  /// Share of them that goes to the region step in two_step; negative: the split that `tune` fitted.
  double region_share = 0.6;
  /// Initial simplex size, times each number's typical frame-to-frame change (thesis Fig. 2-22).
  double simplex_factor = 1.5;
  /// Least size of the edge step's simplex, same unit, when the region step's has collapsed.
  double edge_factor = 0.4;
  /// false: one simplex over all 23 numbers (the reference). true: trunk, left and right arm in turn.
  bool blocks = true;
  /// Rounds over the blocks within a step.
  int rounds = 2;
  /// The region step's objective.
  ObjectiveWeights region{1.0, 0.0, 0.02, 4.0, 0.04, 0.020, 0.002};
  /// The edge step's objective: D_C, with F beside it so that the contours do not leave their regions.
  ObjectiveWeights edge{1.0, 0.15, 0.02, 4.0, 0.04, 0.020, 0.002};
  double tolerance = 1e-4;
  ProposalConfig proposals;
  /// Of the region step's evaluations, what the proposals may use at most: both arms have fewer proposals in
  /// proportion; where it is less than one arm would have in full, one at random has its turn.
  double proposal_share = 0.65;

  /// Throws Error(config) with what to change.
  void validate() const;
};

/// The same for frames that are `frames` times 1/25 s apart: people have moved further, and less is known of
/// where they are expected. 1 changes nothing.
RegistrationConfig for_time_step(RegistrationConfig config, double frames);

/// The search as the thesis has it: one simplex, F alone, then D_C alone, no prior.
RegistrationConfig reference_registration();

struct RegistrationResult {
  Pose pose;
  Score score;
  int region_evaluations = 0;
  int edge_evaluations = 0;
  double region_ms = 0.0;
  double edge_ms = 0.0;
  bool converged = false;  ///< every simplex converged before its iterations were spent
};

/// Two-step registration (thesis 2.4.4.4, 3.5.4) from a pose near the right one: minimise F, then D_C,
/// starting the edge step from the region step's last simplex.
RegistrationResult register_pose(Objective& objective, const Pose& start, const RegistrationConfig& config,
                                 Random& random);

Method parse_method(const std::string& name);
std::string_view to_string(Method method);

}  // namespace telemime
