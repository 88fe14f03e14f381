// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "telemime/live/live_settings.h"

namespace telemime {

/// Replaces the stored outputs.
inline void save_settings(const std::filesystem::path& file, const std::vector<std::string>& outputs) {
  update_settings(file, [&](std::vector<std::string>& stored) { stored = outputs; });
}

}  // namespace telemime
