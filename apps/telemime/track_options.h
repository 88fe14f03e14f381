// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "telemime/tracker/track_request.h"

namespace telemime {

/// The options that `track`, `calibrate` and `live` share, as the user wrote them.
struct TrackOptions {
  TrackRequest request;
  std::string config_file;
  SettingValues settings;                ///< of the public options
  std::vector<std::string> assignments;  ///< NAME=VALUE of --set
  bool show = false;
  bool quiet = false;
};

/// Adds the options of the settings: one for each public setting, made from the table, --config and --set;
/// `options` must outlive the parsing.
void add_setting_options(CLI::App& command, TrackOptions& options);

/// Adds INPUT and all options of tracking to a subcommand; `options` must outlive the parsing.
void add_track_options(CLI::App& command, TrackOptions& options);

/// All settings that are given: the configuration file first, then the command line. Throws Error(config) for
/// the file and Error(usage) for the command line.
SettingValues all_settings(const TrackOptions& options);

/// The request that results from the options: configuration file first, then the command line. Throws
/// Error(config) for the file and Error(usage) for the command line.
TrackRequest make_request(const TrackOptions& options);

}  // namespace telemime
