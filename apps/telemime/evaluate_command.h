// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace telemime {

/// Adds `telemime evaluate POSE --truth truth.json [--json FILE]`. When it is called, it prints a table on
/// the standard output and writes the JSON file; it throws Error(input), Error(output) or Error(usage).
void add_evaluate_command(CLI::App& app);

}  // namespace telemime
