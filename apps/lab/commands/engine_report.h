// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "lab/experiments/engine_bench.h"

namespace telemime {

/// Measures the evaluation engine; gives each table to `show` as soon as it is there.
void report_engine(const EngineOptions& options, const std::function<void(const Table&)>& show);

}  // namespace telemime
