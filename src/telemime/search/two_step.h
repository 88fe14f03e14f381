// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>

#include "telemime/core/random.h"
#include "telemime/search/blocks.h"
#include "telemime/search/objective.h"
#include "telemime/search/proposals.h"

namespace telemime {

enum class Method { regions, edges, two_step };

/// The methods by their names.
inline constexpr std::array<std::pair<std::string_view, Method>, 3> kMethodNames{
    {{"regions", Method::regions}, {"edges", Method::edges}, {"two-step", Method::two_step}}};

/// Settings of the local search; the table (settings_of) gives the meaning, unit and range of each.
struct RegistrationConfig {
  Method method = Method::two_step;  ///< not in the table: Config::tracking.method sets it
  int iterations = 2000;
  double region_share = 0.6;
  double simplex_factor = 1.5;
  double edge_factor = 0.4;
  bool blocks = true;
  int rounds = 2;
  /// Objective of the region step.
  ObjectiveWeights region{.cues = step_weights(&Cue::region_step),
                          .invalid = 4.0,
                          .natural = 0.04,
                          .temporal = 0.020,
                          .trunk = 0.002};
  /// Objective of the edge step: D_C together with F, so that the contours do not leave their regions.
  ObjectiveWeights edge{.cues = step_weights(&Cue::edge_step),
                        .invalid = 4.0,
                        .natural = 0.04,
                        .temporal = 0.020,
                        .trunk = 0.002};
  double tolerance = 1e-4;
  ProposalConfig proposals;
  double proposal_share = 0.65;
};

SettingTable settings_of(RegistrationConfig& config);

/// The same for frames that are `frames` times 1/25 s apart: simplexes grow and predictions weigh less. 1
/// changes nothing.
RegistrationConfig for_time_step(RegistrationConfig config, double frames);

/// The same with the default weights of all cues in the table that are not built in.
RegistrationConfig with_cues(RegistrationConfig config, const CueTable& cues);

/// The search of the thesis: one simplex, first F alone, then D_C alone, without a prior.
RegistrationConfig reference_registration();

struct RegistrationResult {
  Pose pose;
  Score score;
  int region_evaluations = 0;
  int edge_evaluations = 0;
  double region_ms = 0.0;
  double edge_ms = 0.0;
  bool converged = false;  ///< whether every simplex converged within its evaluations
};

/// Two-step registration (thesis 2.4.4.4, 3.5.4) from a pose near the true one: minimises F, then D_C; the
/// edge step starts with the extent of the region step's last simplex.
RegistrationResult register_pose(Objective& objective, const Pose& start, const RegistrationConfig& config,
                                 Random& random);

/// The method of this name (kMethodNames). Throws Error(usage) for an unknown name, with the choices.
Method parse_method(const std::string& name);

}  // namespace telemime
