// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "telemime/core/settings.h"
#include "telemime/search/two_step.h"

namespace telemime {

/// Settings of the particle filter; the table (settings_of) gives the meaning, unit and range of each.
/// reference_filter() gives the values of the thesis.
struct FilterConfig {
  int particles = 2000;
  std::string heuristics = "modes,wd,lo,landmarks,turn,kf,arms";
  std::string estimate = "heaviest";
  std::string model;
  double diffusion = 1.0;
  /// 1 is a Markov chain with independent frames; model errors persist over many frames, so that less is more
  /// accurate.
  double memory = 0.7;
  /// 1 is equation 4.12. The model has the same errors in every pose, so that differences between poses mean
  /// less than the variation of F and D_C over time suggests.
  double trust = 0.1;
  double natural = 4.0;
  double temporal = 2.0;
  double invalid = 400.0;
  int modes = 4;
  double mode_radius = 0.08;
  int mode_least = 100;
  int mode_most = 1200;
  bool blocks = true;
  int turn_evaluations = 200;
  int walk_evaluations = 1000;
  int flip_candidates = 2;
  int landmark_searches = 2;
  int landmark_evaluations = 300;
  /// Few: the searches of the best mode from its prediction and from its last pose nearly always end at the
  /// same pose.
  int second_evaluations = 300;
  double landmark_share = 0.5;
};

SettingTable settings_of(FilterConfig& config);

/// The same with this share (above 0, at most 1) of the evaluations.
FilterConfig with_effort(FilterConfig config, double share);

/// The same for a frame with landmarks: their proposals are near, so that fewer particles are needed.
FilterConfig with_landmarks(FilterConfig config);

/// The same for frames that are `frames` times 1/25 s apart: diffusion grows and the prediction weighs less.
/// 1 changes nothing.
FilterConfig for_time_step(FilterConfig config, double frames);

/// The filter of the thesis with these heuristics: no knowledge without the image but interpenetration, and
/// no memory but that of the Markov chain.
FilterConfig reference_filter(const std::string& heuristics);

}  // namespace telemime
