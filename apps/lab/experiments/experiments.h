// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "lab/experiments/lab.h"
#include "lab/experiments/table.h"
#include "telemime/tracking/filter_model.h"

namespace telemime {

/// The result of one experiment. plots.py draws its figures from the tables.
struct Finding {
  std::vector<Table> tables = {};       ///< titles become file names
  cv::Mat picture = {};                 ///< written as picture.png; empty: none
  std::vector<std::string> notes = {};  ///< observations, one paragraph each
  std::string verdict = {};             ///< whether it agrees with the thesis, and on what
};

/// A finding with the question that it answers.
struct Section {
  std::string id;
  std::string title;
  std::string question;
  Table published;
  Finding finding;
};

/// What the thesis reports for an experiment (its table in apps/lab/published.json); no rows for
/// an unknown id.
Table published_values(const std::string& id);

/// Writes the tables (CSV), the picture and section.json, which names them, to folder/<id>/. Throws
/// Error(output).
void write_section(const std::filesystem::path& folder, const Section& section);

/// Writes a text file. Throws Error(output) that names it.
void write_text(const std::filesystem::path& file, const std::string& text);

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
Finding learned_parts(Lab& lab);         ///< not in the thesis: what networks add, each part left out

/// Processor time of one frame with this number of evaluations, half on F and half on D_C; medians over
/// frames.
struct FrameTime {
  int iterations = 0;
  double features_ms = 0.0;
  double search_ms = 0.0;
  double total_ms() const { return features_ms + search_ms; }
};

/// Thesis Table 3-2 at 160x120.
std::vector<FrameTime> measure_frame_times(Lab& lab);

/// Cost of one F and one D_C at a working size, median of several repeats.
EvaluationCost evaluation_cost(Lab& lab, int width, int height);

/// Features, F and D_C at one working size (thesis Table 3-3).
struct SizeTime {
  double features_ms = 0.0;
  EvaluationCost cost;
};

/// Tables 3-1, 3-2 and 3-3: our values beside the published ones.
Table background_time_table(Lab& lab);
Table frame_time_table(const std::vector<FrameTime>& times);
Table size_time_table(const std::vector<SizeTime>& times);

/// The working sizes of Table 3-3.
std::vector<SizeTime> measure_sizes(Lab& lab);

/// 0 for an empty list.
double median_of(std::vector<double> values);

/// Estimates the parameters of data/filter.json from sequences with truth (folders as read_clip reads them),
/// each tracked with `config`. Of the end-effector space only the swivel angle is estimated: the wrist's
/// standard deviations are the thesis's. `progress` may be empty. Throws Error(input), Error(tracking).
FilterModel learn_filter_model(const std::vector<std::filesystem::path>& clips, const Config& config,
                               const std::function<void(const std::string&)>& progress);

}  // namespace telemime
