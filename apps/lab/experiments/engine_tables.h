// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "lab/experiments/engine_bench.h"

namespace telemime {

/// The time of each stage of `simd` in one evaluation, on one thread, at the three image sizes: the time up
/// to a stage minus the time up to the previous one.
Table stage_table(const EngineOptions& options);

/// One evaluation with each set of vector instructions that this processor has, on one thread.
Table instruction_set_table(const EngineOptions& options);

/// One evaluation with plain calls of OpenCV (opencv_baseline.h) beside `simd`, one thread each.
Table opencv_table(const EngineOptions& options);

/// Thesis Table 4-1: 100 to 700 overlap histograms at 160x120, with the published times beside.
Table overlap_time_table(const EngineOptions& options);

}  // namespace telemime
