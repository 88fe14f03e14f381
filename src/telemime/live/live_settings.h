// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace telemime {

/// Reads the user's settings on the page that later runs reuse: the URLs of the outputs, in the order in
/// which they were added; none if the file does not exist. Throws Error(config) with the file's name and the
/// reason.
std::vector<std::string> load_settings(const std::filesystem::path& file);

/// Reads the file, applies `change` to the outputs and writes it, under a lock, so that concurrent programs
/// do not undo each other's changes. Unknown fields are preserved; an unusable file is renamed and replaced.
/// The file and a new folder are readable by this user only. The write is atomic and follows symbolic links.
/// At most the newest 64 outputs are stored. Throws Error(output).
void update_settings(const std::filesystem::path& file,
                     const std::function<void(std::vector<std::string>&)>& change);

}  // namespace telemime
