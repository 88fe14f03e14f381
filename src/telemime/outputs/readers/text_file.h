// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace telemime {

/// The whole content of a file. Throws Error(input) that names the file and the reason.
std::string read_text_file(const std::filesystem::path& file);

}  // namespace telemime
