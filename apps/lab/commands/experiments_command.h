// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace telemime {

/// Adds `telemime experiments ID... [--data DIR] [--out DIR] [--quick]`: measures tables and figures of the
/// thesis again and writes CSV, SVG and report.html.
void add_experiments_command(CLI::App& app);

}  // namespace telemime
