// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace telemime {

/// `telemime live`: from the webcam to an avatar, on a page and in other programs.
void add_live_command(CLI::App& app);

}  // namespace telemime
