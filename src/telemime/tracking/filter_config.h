// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "telemime/search/two_step.h"

namespace telemime {

/// Settings of the particle filter. The defaults are ours; reference_filter() gives the thesis's.
struct FilterConfig {
  /// Particles of a frame; each is one evaluation. The thesis's local search spends no more. With `blocks`
  /// the searches take their evaluations from the children of their mode; where these are too few (two
  /// searches of the best mode, mode_least of the others) and for turned trunks they come on top.
  int particles = 2000;
  std::string heuristics = "modes,wd,lo,turn,kf";  ///< names of kHeuristics with commas; empty: CONDENSATION
  std::string estimate = "heaviest";               ///< or mean
  std::string model;       ///< file of the numbers that `telemime-lab learn` writes; empty: data/filter.json
  double diffusion = 1.0;  ///< S of equation 4.13: multiplies every standard deviation
  /// Share of the modes' log weights that the next generation remembers (heuristic modes; without it all): 1
  /// is a Markov chain with independent frames; errors of the model last for many frames, so less is nearer
  /// to the truth.
  double memory = 0.7;
  /// Multiplies the log likelihood of the image (1: equation 4.12 as it stands). What the model gets wrong of
  /// a person it gets wrong in every pose, so differences between poses tell less than the spread of F and
  /// D_C over time says.
  double trust = 0.1;
  /// What is known without the image, as log likelihood: nats for each unit of natural_cost, for the squared
  /// way of elbows and wrists from where they are expected (ObjectiveWeights::temporal), for each metre of
  /// interpenetration.
  double natural = 4.0;
  double temporal = 2.0;
  double invalid = 400.0;
  int modes = 4;  ///< that are kept apart
  double mode_radius =
      0.08;              ///< m, farthest that an elbow or wrist of one mode may be from its best particle
  int mode_least = 100;  ///< evaluations that each mode gets at least
  int mode_most = 1200;  ///< at most, for its local search
  /// false: the local search is the thesis's single simplex over all moving numbers. true:
  /// RegistrationConfig.
  bool blocks = true;
  int turn_evaluations = 200;  ///< for the search of each turned trunk
  /// The same where the best trunk is far from upright and facing where expected. No more than half of the
  /// particles, and no fewer than `turn_evaluations`.
  int walk_evaluations = 1000;
  int flip_candidates = 2;  ///< families whose best particle is flipped

  /// Throws Error(config) with what to change.
  void validate() const;
};

/// The same with a share (above 0, at most 1) of the evaluations.
FilterConfig with_effort(FilterConfig config, double share);

/// The same for frames that are `frames` times 1/25 s apart: people have moved further, and less is known of
/// where they are expected. 1 changes nothing.
FilterConfig for_time_step(FilterConfig config, double frames);

/// The thesis's filter: `heuristics` as given, no prior knowledge but what is invalid, no memory but the
/// Markov chain's.
FilterConfig reference_filter(const std::string& heuristics);

}  // namespace telemime
