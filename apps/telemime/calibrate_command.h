// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace telemime {

/// Adds `telemime calibrate INPUT --out FILE [options]`.
void add_calibrate_command(CLI::App& app);

}  // namespace telemime
