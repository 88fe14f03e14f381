// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string_view>

#include "telemime/core/lens.h"
#include "telemime/tracker/tracker_state.h"

namespace telemime {

/// What `telemime calibrate` keeps: the person, the camera, and the look of person and scene.
struct PersonFile {
  CalibratedPerson person;
  Camera camera;
  ImageCalibration image;
  Lens lens = {};  ///< of the same camera; `camera` is without its distortion
};

/// Writes FILE (JSON: shape, camera) and beside it FILE.scene.yml.gz (colours and background). Throws
/// Error(output).
void save_person(const PersonFile& person, const std::filesystem::path& file);

/// The JSON part of such a file; the image part stays empty. `name` is for messages. Throws Error(config).
PersonFile parse_person(std::string_view text, const std::filesystem::path& name);

/// Reads both again. Throws Error(config) that names the file and what is missing or out of range.
PersonFile load_person(const std::filesystem::path& file);

}  // namespace telemime
