// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <vector>

#include "lab/experiments/lab.h"
#include "lab/experiments/table.h"

namespace telemime {

/// Processor time of one frame with this number of evaluations, half on F and half on D_C; medians over
/// frames.
struct FrameTime {
  int iterations = 0;
  double features_ms = 0.0;
  double search_ms = 0.0;
  double total_ms() const { return features_ms + search_ms; }
};

/// Thesis Table 3-2 at 160x120.
std::vector<FrameTime> measure_frame_times(Lab& lab, std::span<const int> iterations);

/// Cost of one F and one D_C at a working size, median of several repeats.
EvaluationCost evaluation_cost(Lab& lab, int width, int height);

/// Features, F and D_C at one working size (thesis Table 3-3).
struct SizeTime {
  int width = 0;
  int height = 0;
  double features_ms = 0.0;
  EvaluationCost cost;
};
SizeTime measure_size(Lab& lab, int width, int height);

/// Tables 3-1, 3-2 and 3-3: our values beside the published ones.
Table background_time_table(Lab& lab);
Table frame_time_table(const std::vector<FrameTime>& times);
Table size_time_table(const std::vector<SizeTime>& times);

/// The working sizes of Table 3-3.
std::vector<SizeTime> measure_sizes(Lab& lab);

/// 0 for an empty list.
double median_of(std::vector<double> values);

}  // namespace telemime
