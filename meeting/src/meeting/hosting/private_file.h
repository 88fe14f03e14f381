// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

namespace telemime::meeting {

/// Replaces a file by another one that only its user may read or write (0600). Readers find the old or the
/// new one, never a part. `lasting`: when it returns it is on the disk, and outlives a power cut. Throws
/// Error(output).
void write_private_file(const std::filesystem::path& file, const std::string& content, bool lasting = false);

/// Makes the folders that are missing, for their user alone (0700). Throws Error(output).
void make_private_folders(const std::filesystem::path& folder);

}  // namespace telemime::meeting
