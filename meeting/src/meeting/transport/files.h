// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <string>

namespace telemime::meeting {

/// A small file that the user named.
struct SmallFile {
  std::string content;
  mode_t mode = 0;  ///< its permissions
  uid_t owner = 0;
};

enum class SymbolicLinks { follow, refuse };

/// Reads a whole file of at most `most` bytes. Refuses pipes, terminals and devices at once, because opening
/// or reading one may block forever. Throws std::system_error, or std::runtime_error with a reason that does
/// not include the file's name.
SmallFile read_small_file(const std::filesystem::path& file, std::size_t most,
                          SymbolicLinks links = SymbolicLinks::follow);

/// Replaces a file atomically by one that only its owner may read or write (0600). `durable`: it is on the
/// disk when this returns, and survives a power failure. Throws Error(output).
void write_private_file(const std::filesystem::path& file, const std::string& content, bool durable = false);

/// Creates the missing folders with permissions for their owner only (0700). Throws Error(output).
void make_private_folders(const std::filesystem::path& folder);

}  // namespace telemime::meeting
