// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace telemime {

/// `telemime room replay`: plays a recording of a room into a room.
void add_room_replay_command(CLI::App& room);

}  // namespace telemime
