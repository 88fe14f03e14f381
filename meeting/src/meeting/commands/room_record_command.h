// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace telemime {

/// `telemime room record`: writes all that is said in a room to a file.
void add_room_record_command(CLI::App& room);

}  // namespace telemime
