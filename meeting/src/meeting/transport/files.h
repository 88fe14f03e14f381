// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <string>

namespace telemime::meeting {

/// A small file that somebody named in an output.
struct SmallFile {
  std::string content;
  mode_t mode = 0;  ///< who may read and write it
};

/// Reads a whole file of at most `most` bytes. A pipe, a terminal or a device is refused at once: whoever
/// opens or reads one may wait for ever. Throws std::runtime_error with the reason in words, without the
/// file's name.
SmallFile read_small_file(const std::filesystem::path& file, std::size_t most);

}  // namespace telemime::meeting
