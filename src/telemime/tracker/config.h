// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "telemime/image/features.h"
#include "telemime/search/calibration.h"
#include "telemime/search/two_step.h"
#include "telemime/tracker/smoother.h"
#include "telemime/tracking/filter_config.h"
#include "telemime/tracking/trajectory.h"

namespace telemime {

/// When a person counts as found, and when as lost.
struct TrackingConfig {
  /// heuristics and condensation: the particle filter with FilterConfig's heuristics and with none; two-step:
  /// the search of RegistrationConfig alone.
  std::string method = "heuristics";
  double lost_region = 0.62;   ///< F above this for `patience` frames: lost
  double found_region = 0.55;  ///< F at or below this after a search: found
  int patience = 8;            ///< frames of 1/25 s
  int retry_every = 3;         ///< frames of 1/25 s between searches for a person while lost
  /// Frames to wait for a first frame in which the shape can be fitted (thesis 3.3); then the average body
  /// starts; in a file, the frames that the look-ahead picks may still fit it.
  int calibration_patience = 10;
  /// Of a file: frames lost before somebody is found that may be followed back from there (GapFiller); 0:
  /// none.
  int fill_back = 75;
  double velocity = 0.5;  ///< share of the last frame's motion of the arms that is expected again
};

/// The whole configuration; every default stands in the struct of its own room.
struct Config {
  std::uint64_t seed = 1;
  std::string limits = "anatomical";  ///< reference, anatomical or a file
  double field_of_view = 60.0;        ///< degrees, horizontal; used when there is no camera file
  std::string backend = "simd";       ///< what evaluates poses: a name of kBackends
  int threads = 0;                    ///< for the search; 0: as many as the machine has
  std::optional<double>
      budget_ms;  ///< time for the search in each frame: replaces registration.iterations (tune)
  ImageConfig image;
  CalibrationConfig calibration;
  RegistrationConfig registration;
  FilterConfig filter;
  TrackingConfig tracking;
  SmoothingOptions smoothing;
  bool look_back = false;  ///< `track --offline`: decide with the frames that come after, too
  TrajectoryConfig offline;
  CueTable cues;  ///< what the image is compared by; set by add_cue(), not by a file

  /// The working image has as many pixels as one of 320x240 by default, in the input's shape (fitted_to).
  Config();
  /// Throws Error(config) with what to change.
  void validate() const;
};

/// Adds a cue of the program's own with its default weights. Throws Error(usage) as CueTable::add does.
void add_cue(Config& config, const Cue& cue);

/// The particle filter that tracking.method asks for: with condensation the thesis's, without heuristics,
/// with the particles, model, diffusion and estimate that are set.
FilterConfig filter_of(const Config& config);

/// The effective configuration, as written beside the results.
nlohmann::json to_json(const Config& config);

/// Replaces the values that `json` holds. Throws Error(config) that names an unknown key, a wrong type or a
/// number that is not finite; `config` is unchanged then.
void update_from_json(Config& config, const nlohmann::json& json);

/// The same from the text of a file; `name` is for messages. Throws Error(config).
void parse_config(Config& config, std::string_view text, const std::filesystem::path& name);

/// The same from a file. Throws Error(config).
void update_from_file(Config& config, const std::filesystem::path& file);

}  // namespace telemime
