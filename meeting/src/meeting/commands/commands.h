// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "telemime/streaming/web_server.h"

namespace telemime::meeting {

/// The files that the web server of a meeting serves: its page and avatars.
struct MeetingFiles {
  std::vector<std::string> looks;  ///< names of the avatars to choose from
  /// The file at a path ("/room", "/assets/a.js", "/avatars/LOOK.vrm"); as WebHandlers::get.
  std::function<std::optional<WebContent>(const std::string& path)> get;
};

/// Returns the files, including the avatars of a folder of the user (empty: none). Throws Error(usage) when
/// the folder cannot be read.
using OpenFiles = std::function<MeetingFiles(const std::filesystem::path& avatars)>;

/// Adds `telemime meeting`, which opens a meeting on this computer, and its subcommands below.
void add_meeting_command(CLI::App& app, OpenFiles open_files);

/// `meeting record` writes the messages of a meeting to a file; `meeting replay` sends them to a meeting
/// again.
void add_recording_commands(CLI::App& meeting);

/// `meeting people`: synthetic participants that send motion as trackers do, for tests.
void add_people_command(CLI::App& meeting);

}  // namespace telemime::meeting
