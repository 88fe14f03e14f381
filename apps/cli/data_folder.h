// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace telemime {

/// The folder of the program's data: PREFIX/share/telemime if it is installed, otherwise data/ of the source
/// tree it was built from. Throws Error(input) if neither exists.
std::filesystem::path data_folder();

/// The folder of the avatars that the program ships: PREFIX/share/telemime/avatars if it is installed,
/// otherwise avatars/ of the build tree. Throws Error(input) if neither exists.
std::filesystem::path avatar_folder();

}  // namespace telemime
