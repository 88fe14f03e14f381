// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace telemime {

/// Where the data of this program is: beside it where it was installed (PREFIX/share/telemime), else in the
/// sources that it was built from. Throws Error(input) when it is in neither place.
std::filesystem::path data_folder();

}  // namespace telemime
