// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace telemime {

/// `telemime room`: opens a room that people share on this machine. What else can be done with rooms hangs
/// under it as subcommands.
void add_room_command(CLI::App& app);

}  // namespace telemime
