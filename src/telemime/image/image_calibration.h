// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "telemime/image/background_model.h"
#include "telemime/image/person_colours.h"

namespace telemime {

/// The learned models of scene and person.
struct ImageCalibration {
  BackgroundModel background;
  ColourMixture surroundings;  ///< empty unless the background was learned around a person
  bool doubtful = false;       ///< the background was learned around a person and may contain parts of them
  PersonColours colours;
};

/// Writes a calibration with cv::FileStorage. The extension selects the format: .yml, .xml or .json, with .gz
/// appended for compression (recommended: .yml.gz). Throws Error(output) that names the file.
void save_calibration(const ImageCalibration& calibration, const std::filesystem::path& file);

/// Reads a calibration written by save_calibration; all values are restored exactly. Throws Error(config)
/// that names the file and what is missing or damaged.
ImageCalibration load_calibration(const std::filesystem::path& file);

}  // namespace telemime
