// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>

namespace telemime {

/// Adds `telemime avatar`: writes one of the project's own avatars as a VRM file.
void add_avatar_command(CLI::App& app);

}  // namespace telemime
