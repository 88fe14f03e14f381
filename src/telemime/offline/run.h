// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "telemime/capture/source.h"
#include "telemime/outputs/all.h"
#include "telemime/tracker/config.h"
#include "telemime/tracker/track_request.h"
#include "telemime/tracker/tracker.h"

namespace telemime {

/// Where a run stands; handed to the viewer after each frame.
struct Progress {
  std::int64_t frames = 0;
  std::int64_t total = 0;               ///< 0: not known
  double seconds = 0.0;                 ///< since the first frame
  const TrackedFrame* frame = nullptr;  ///< null while the program looks ahead to fit the body
  const cv::Mat* overlay = nullptr;     ///< null when nobody wants one
};

/// What the viewer may ask for between frames.
enum class Wish { go_on, stop, recalibrate };

struct RunHooks {
  std::function<Wish(const Progress&)> progress;    ///< after each frame; may be empty
  std::function<void(const std::string&)> message;  ///< what the user should know, in words; may be empty
  bool draw = false;                                ///< make overlays even when none is written
};

struct TrackSummary {
  std::int64_t frames = 0;
  std::int64_t tracked = 0;
  std::int64_t first_tracked = -1;
  double seconds = 0.0;
  bool interrupted = false;
  nlohmann::json report;  ///< what report.json holds
};

/// Tracks a whole input and writes the results. Every file is valid at every moment. Throws Error(input) for
/// an input that cannot be read, Error(output) when results cannot be written, Error(config) for settings.
TrackSummary run_track(const TrackRequest& request, const RunHooks& hooks);

/// Calibrates on the first good frame of an input (of a file: on many after it, too) and writes the
/// calibration to `file` (person_file.h). Throws as run_track does, and Error(tracking) with the last reason
/// when no frame would do.
TrackerCalibration run_calibrate(const TrackRequest& request, const RunHooks& hooks,
                                 const std::filesystem::path& file);

}  // namespace telemime
