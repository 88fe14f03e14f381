// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace telemime {

/// Adds `telemime synth GESTURE|all --out DIR [options]`: clips with exact truth. When it is called it writes
/// DIR/<gesture>/..., reports on the standard error and throws Error(usage) or Error(output).
void add_synth_command(CLI::App& app);

}  // namespace telemime
