// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "meeting/commands/commands.h"

namespace telemime {

/// The files that `telemime meeting` serves: the page in this program, its avatars, and those of a folder of
/// the user (empty: none). Throws Error(usage) when the folder cannot be read.
meeting::MeetingFiles meeting_files(const std::filesystem::path& avatars);

}  // namespace telemime
