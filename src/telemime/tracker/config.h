// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "telemime/core/settings.h"
#include "telemime/image/features.h"
#include "telemime/search/calibration.h"
#include "telemime/search/two_step.h"
#include "telemime/tracker/smoother.h"
#include "telemime/tracking/filter_config.h"
#include "telemime/tracking/trajectory.h"

namespace telemime {

/// Settings of losing and finding a person; the table (settings_of) gives the meaning, unit and range of
/// each.
struct TrackingConfig {
  std::string method = "heuristics";
  double lost_region = 0.62;
  double found_region = 0.55;
  int patience = 8;
  int retry_every = 3;
  int calibration_patience = 10;
  int fill_back = 75;
  double velocity = 0.5;
};

/// The whole configuration. A setting whose name has no dot is one of the fifteen public ones, which are
/// options of the program, too; all others are for experts.
struct Config {
  std::string quality = "balanced";
  std::uint64_t seed = 1;
  std::string limits = "anatomical";
  double field_of_view = 60.0;
  std::string backend = "simd";
  int threads = 0;
  std::optional<double> budget_ms;
  ImageConfig image;
  CalibrationConfig calibration;
  RegistrationConfig registration;
  FilterConfig filter;
  TrackingConfig tracking;
  SmoothingOptions smoothing;
  bool look_back = true;
  TrajectoryConfig offline;
  bool face = true;
  std::string cue_names = "regions,contours,landmarks,bones";
  bool hands = true;
  CueTable cues;  ///< what the image is compared by; set by add_cue(), not by a file

  /// The working image has 320x240 pixels, or as many in the shape of the input (fitted_to).
  Config();
  /// Throws Error(config) that names the setting and its range.
  void validate() const { check_settings(*this); }
};

/// Adds a cue of the program's own with its default weights. Throws Error(usage) as CueTable::add does.
void add_cue(Config& config, const Cue& cue);

/// The table of all settings, the public ones first.
SettingTable settings_of(Config& config);

/// Whether networks find the person: a cue needs them, and the models are installed.
bool uses_networks(const Config& config);

/// Whether the person's face is tracked: networks find the person, and those of faces are installed.
bool uses_face(const Config& config);

/// Whether the hands of the person are tracked: the networks find the person, and those of hands are
/// installed.
bool uses_hands(const Config& config);

/// Does `tracking.method` use the particle filter?
bool uses_filter(const Config& config);

/// The configuration with what its method implies: `condensation` takes the particle filter of the thesis
/// without heuristics, and keeps particles, model, diffusion and estimate; `regions` and `edges` do one step
/// of the search.
Config resolved(Config config);

/// The effective configuration, as it is written beside the results.
nlohmann::json to_json(Config config);

/// Sets the values by the names of their settings; `quality` first, since it presets others. Throws
/// Error(config) that names an unknown setting, a value of a wrong type or one out of its range; `config` is
/// unchanged then.
void update(Config& config, const SettingValues& values);

/// The values of a configuration file: JSON with comments; groups are objects. Throws Error(config).
SettingValues read_settings(const std::filesystem::path& file);

/// The same from the text of a file; `name` is for messages.
SettingValues parse_settings(std::string_view text, const std::filesystem::path& name);

}  // namespace telemime
