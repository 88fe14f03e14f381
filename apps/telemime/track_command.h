// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace telemime {

/// Adds `telemime track INPUT [options]`.
void add_track_command(CLI::App& app);

}  // namespace telemime
