// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace telemime {

/// `telemime room people`: synthetic people who take part in a room as trackers do, to try it.
void add_room_people_command(CLI::App& room);

}  // namespace telemime
