// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace telemime {

/// Adds `telemime tune [--out FILE] [--budget MS]`: measures what one F and one D_C cost on this machine and
/// prints and writes the best split of a time budget.
void add_tune_command(CLI::App& app);

}  // namespace telemime
