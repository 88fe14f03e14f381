// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace telemime {

/// What the user chose on the page that holds for later runs, too.
struct LiveSettings {
  std::vector<std::string> outputs;  ///< URLs, in the order in which they were added
};

/// Reads such a file. None are there when there is no file. Throws Error(config) that names the file and what
/// is wrong with it.
LiveSettings load_settings(const std::filesystem::path& file);

/// Writes the file, and the folder that it is in, for this user alone: the new one is there whole or the old
/// one stays. Throws Error(output).
void save_settings(const std::filesystem::path& file, const LiveSettings& settings);

}  // namespace telemime
