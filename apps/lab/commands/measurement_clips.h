// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

namespace telemime {

/// The four gestures for measurements: `given`, else the development clips beside the checkout, else made by
/// `telemime synth` below `out` (320x240; kept for the next run).
std::filesystem::path measurement_data(const std::filesystem::path& given, const std::filesystem::path& out);

}  // namespace telemime
