// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace telemime {

/// The folder of the program that runs; or of the shared library (the Python module) that this code is in.
std::filesystem::path code_folder();

/// PREFIX/share/telemime of the installation that the folder `code` belongs to: below its nearest parent
/// where that has `entry`. Empty if none has.
std::filesystem::path installed_folder(const std::filesystem::path& code, const std::filesystem::path& entry);

}  // namespace telemime
