// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "telemime/capture/input_kind.h"
#include "telemime/capture/source.h"

namespace telemime {

/// Order of names with runs of digits as numbers of any length: "frame2" is before "frame10". Of two names
/// that differ in leading zeros alone, the shorter one is first.
bool natural_less(const std::string& a, const std::string& b);

/// The image files of a folder, a pattern or an image name, in natural order (frame2 before frame10). Throws
/// Error(input) if there are none.
std::vector<std::filesystem::path> image_files(const std::string& input, InputKind kind);

/// The place of each file in a sequence, by its number where the names differ in nothing else; otherwise in
/// the given order.
struct Numbering {
  std::vector<std::int64_t> places;  ///< from 0
  std::string missing;               ///< "3 to 5, 8" in the file names' numbers; empty: none
  std::int64_t count = 0;            ///< of the missing ones
};

/// `files` are those of image_files(input, kind).
Numbering numbering_of(const std::vector<std::filesystem::path>& files, const std::string& input,
                       InputKind kind);

/// A sequence of image files at InputOptions::rate, or 25 frames per second. Where the names differ in their
/// last number alone, it is the frame's: missing ones take their time. For them, and for an image that cannot
/// be read, index and time are skipped, and complaint() names it. Throws Error(input) if no image can be
/// read.
std::unique_ptr<Source> open_image_sequence(const std::string& input, InputKind kind,
                                            const InputOptions& options = {});

}  // namespace telemime
