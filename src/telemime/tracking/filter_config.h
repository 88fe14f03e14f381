// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "telemime/search/two_step.h"

namespace telemime {

/// Settings of the particle filter. The defaults are those of this program; reference_filter() gives the
/// thesis's.
struct FilterConfig {
  /// Particles per frame; each is one evaluation. The local search of the thesis spends no more. With
  /// `blocks` the searches take their evaluations from the children of their mode; where these are too few
  /// (two searches of the best mode, mode_least of the others) and for turned trunks evaluations are added.
  int particles = 2000;
  std::string heuristics = "modes,wd,lo,turn,kf";  ///< names of kHeuristics with commas; empty: CONDENSATION
  std::string estimate = "heaviest";               ///< the heaviest particle, or the weighted mean: mean
  std::string model;       ///< file of numbers written by `telemime-lab learn`; empty: data/filter.json
  double diffusion = 1.0;  ///< S of equation 4.13: multiplies every standard deviation
  /// Share of the modes' log weights that the next generation inherits (heuristic modes; 1 without it): 1 is
  /// a Markov chain with independent frames; model errors persist over many frames, so that less is more
  /// accurate.
  double memory = 0.7;
  /// Factor of the image's log likelihood (1: equation 4.12). The model has the same errors in every pose, so
  /// that differences between poses mean less than the variation of F and D_C over time suggests.
  double trust = 0.1;
  /// Log likelihood of what is known without the image: nats per unit of natural_cost, per unit of
  /// distance_from_predicted, and per metre of interpenetration.
  double natural = 4.0;
  double temporal = 2.0;
  double invalid = 400.0;
  int modes = 4;              ///< most modes that are kept apart
  double mode_radius = 0.08;  ///< m, largest distance of an elbow or wrist of one mode from its best particle
  int mode_least = 100;       ///< least evaluations of each mode
  int mode_most = 1200;       ///< most evaluations of a mode's local search
  /// Whether the local search is that of RegistrationConfig; false: one simplex over all moving numbers
  /// (thesis).
  bool blocks = true;
  int turn_evaluations = 200;  ///< evaluations for the search of each turned trunk
  /// The same where the best trunk leans or is turned far from the predicted heading: at most half of the
  /// particles, at least `turn_evaluations`.
  int walk_evaluations = 1000;
  int flip_candidates = 2;  ///< families whose best particle is flipped

  /// Throws Error(config) that says what to change.
  void validate() const;
};

/// The same with this share (above 0, at most 1) of the evaluations.
FilterConfig with_effort(FilterConfig config, double share);

/// The same for frames that are `frames` times 1/25 s apart: diffusion grows and the prediction weighs less.
/// 1 changes nothing.
FilterConfig for_time_step(FilterConfig config, double frames);

/// The filter of the thesis with these heuristics: no knowledge without the image but interpenetration, and
/// no memory but that of the Markov chain.
FilterConfig reference_filter(const std::string& heuristics);

}  // namespace telemime
