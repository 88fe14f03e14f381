// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace telemime {

/// The user's settings on the page that later runs reuse.
struct LiveSettings {
  std::vector<std::string> outputs;  ///< URLs, in the order in which they were added
};

/// Reads a settings file; defaults if it does not exist. Throws Error(config) with the file's name and the
/// reason.
LiveSettings load_settings(const std::filesystem::path& file);

/// Reads the file, applies `change` and writes it, under a lock, so that concurrent programs do not undo each
/// other's changes. Unknown fields are preserved; an unusable file is renamed and replaced. The file and a
/// new folder are readable by this user only. The write is atomic and follows symbolic links. At most the
/// newest 64 outputs are stored. Throws Error(output).
void update_settings(const std::filesystem::path& file, const std::function<void(LiveSettings&)>& change);

/// Replaces the stored settings.
void save_settings(const std::filesystem::path& file, const LiveSettings& settings);

}  // namespace telemime
