// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace telemime {

/// Adds `telemime config`: prints the effective settings, or explains them.
void add_config_command(CLI::App& app);

}  // namespace telemime
