// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "telemime/capture/input_kind.h"
#include "telemime/capture/source.h"

namespace telemime {

/// The image files that a folder, a pattern or an image name stands for, in natural order (frame2 before
/// frame10). Throws Error(input) when there are none.
std::vector<std::filesystem::path> image_files(const std::string& input, InputKind kind);

/// A sequence of image files at 25 frames a second. An image that cannot be read is left out: its index and
/// time are skipped and a complaint names it; the same for numbers missing in a %d pattern.
/// Throws Error(input) when no image can be read.
std::unique_ptr<Source> open_image_sequence(const std::string& input, InputKind kind);

}  // namespace telemime
