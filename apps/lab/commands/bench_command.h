// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace telemime {

/// Adds `telemime bench [--json FILE] [--data DIR] [--quick]`: the thesis's tables of computing times with
/// the published values beside.
void add_bench_command(CLI::App& app);

}  // namespace telemime
