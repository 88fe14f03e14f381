// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <string>

namespace telemime {

/// Writes what is generated from the program's own options, so that it cannot differ from them: the manual
/// pages FOLDER/man1/telemime.1, telemime-live.1, telemime-meeting-record.1 and so on, and the completion of
/// the command line in bash, FOLDER/completions/telemime. Throws Error(output) if a file cannot be written.
void write_reference(const CLI::App& app, const std::filesystem::path& folder, const std::string& version);

}  // namespace telemime
