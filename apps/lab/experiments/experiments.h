// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

#include "lab/experiments/lab.h"
#include "lab/experiments/report.h"

namespace telemime {

/// A table or figure of the thesis that can be measured again.
struct Experiment {
  std::string_view id;
  std::string_view title;
  std::string_view question;
  Finding (*run)(Lab& lab);
};

/// Every experiment, in the order of the thesis.
std::span<const Experiment> experiments();

/// The experiment with this id, or null.
const Experiment* find_experiment(std::string_view id);

/// Runs one experiment and adds what the thesis reports.
Section run_experiment(const Experiment& experiment, Lab& lab);

/// The measuring conditions, one line each, for the head of the report.
std::vector<std::string> conditions(const LabOptions& options);

/// "Agrees: ", "Partly agrees: " or "Differs: ", by how many of the statements hold, followed by `text`.
std::string verdict(std::initializer_list<bool> statements, const std::string& text);

Finding background_times(Lab& lab);      ///< T3-1
Finding background_in_light(Lab& lab);   ///< F3-6
Finding simplex_size(Lab& lab);          ///< F2-22
Finding limited_regions(Lab& lab);       ///< F3-13
Finding limited_edges(Lab& lab);         ///< F3-14
Finding frame_times(Lab& lab);           ///< T3-2
Finding size_times(Lab& lab);            ///< T3-3
Finding region_residuals(Lab& lab);      ///< F3-16
Finding contour_residuals(Lab& lab);     ///< F3-17
Finding region_mistrackings(Lab& lab);   ///< F3-18
Finding contour_mistrackings(Lab& lab);  ///< F3-19
Finding steps_to_convergence(Lab& lab);  ///< F3-24
Finding steps_sharing(Lab& lab);         ///< F3-25
Finding surfaces_3d(Lab& lab);           ///< F3-26
Finding surfaces_2d(Lab& lab);           ///< F3-27
Finding quadratic(Lab& lab);             ///< F3-28
Finding tangent_point(Lab& lab);         ///< F3-29
Finding best_curve(Lab& lab);            ///< F3-30
Finding wd_accuracy(Lab& lab);           ///< F4-11
Finding wd_robustness(Lab& lab);         ///< F4-12
Finding hpm_accuracy(Lab& lab);          ///< F4-13
Finding hpm_robustness(Lab& lab);        ///< F4-14
Finding lo_accuracy(Lab& lab);           ///< F4-16
Finding lo_robustness(Lab& lab);         ///< F4-17
Finding kf_accuracy(Lab& lab);           ///< F4-20
Finding kf_robustness(Lab& lab);         ///< F4-21
Finding ee_accuracy(Lab& lab);           ///< F4-25
Finding ee_robustness(Lab& lab);         ///< F4-26
Finding all_accuracy(Lab& lab);          ///< F4-29
Finding all_robustness(Lab& lab);        ///< F4-30
Finding real_clips(Lab& lab);            ///< F4-33
Finding overlap_times(Lab& lab);         ///< T4-1
Finding ablation(Lab& lab);              ///< not in the thesis: each cue and heuristic left out
Finding levers(Lab& lab);                ///< not in the thesis: each part of the program left out

}  // namespace telemime
