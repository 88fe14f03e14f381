// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "telemime/image/feature_config.h"

namespace telemime {

/// Writes what calibration learned by cv::FileStorage: the ending of the name chooses .yml, .xml or .json,
/// with .gz behind it compressed (recommended: .yml.gz). Throws Error(output) that names the file.
void save_calibration(const ImageCalibration& calibration, const std::filesystem::path& file);

/// Reads it again, exactly. Throws Error(config) that names the file and what is missing or damaged.
ImageCalibration load_calibration(const std::filesystem::path& file);

}  // namespace telemime
