// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
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

/// Reads, has `change` change it, and writes: what another program did in the meantime is not undone, and two
/// that do it at the same time wait for each other. A file that cannot be used is begun anew; what it holds
/// beside the LiveSettings stays. The file, and the folder that it is in, are made for this user alone: the
/// new one is there whole or the old one stays, at the end of a symbolic link, too. Of more than 64 outputs
/// the newest are kept. Throws Error(output).
void update_settings(const std::filesystem::path& file, const std::function<void(LiveSettings&)>& change);

/// update_settings to these.
void save_settings(const std::filesystem::path& file, const LiveSettings& settings);

}  // namespace telemime
