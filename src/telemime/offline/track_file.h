// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "telemime/tracker/track_frame.h"
#include "telemime/tracker/track_request.h"

namespace telemime {

/// How far a run has come; passed to the viewer after each frame.
struct Progress {
  std::int64_t frames = 0;
  std::int64_t total = 0;               ///< 0: not known
  double seconds = 0.0;                 ///< since the first frame
  const MotionFrame* motion = nullptr;  ///< not smoothed; null while the program looks ahead to fit the body
};

/// What the viewer may ask for between frames.
enum class ViewerRequest { none, stop, recalibrate };

struct RunHooks {
  std::function<ViewerRequest(const Progress&)> progress;  ///< after each frame; may be empty
  std::function<void(const std::string&)> message;         ///< notes for the user; may be empty
  std::function<void(const StreamHeader&)> person;         ///< once, before the first frame; may be empty
  std::function<void(const MotionFrame&)> motion;          ///< each frame as it is written; may be empty
  /// Each overlay (draw_overlay) as it is drawn, often many in a row; with it they are drawn even when none
  /// is written. May be empty.
  std::function<void(const cv::Mat&)> picture;
};

/// Number of frames that a run takes from its input; 0: not known.
inline std::int64_t frames_to_come(const TrackRequest& request, const SourceInfo& info) {
  return request.most_frames > 0 && info.frames > 0 ? std::min(request.most_frames, info.frames)
                                                    : std::max(request.most_frames, info.frames);
}

struct TrackSummary {
  std::int64_t frames = 0;
  std::int64_t tracked = 0;
  std::int64_t first_tracked = -1;
  double seconds = 0.0;
  bool interrupted = false;
  nlohmann::json report;  ///< what report.json holds
};

/// Tracks a whole file and writes the results, if the request names a folder for them. Every output file is
/// valid at every moment. The input is opened twice at most: to learn the background from it, where no
/// background clip is given, and to track. Throws Error(input) for an input that cannot be read or is a
/// camera, Error(output) when results cannot be written, Error(config) for settings.
TrackSummary track_file(const TrackRequest& request, const RunHooks& hooks);

/// Calibrates the person in a file, as track_file() does before it writes the first frame, and saves the
/// result (person_file.h). Throws as track_file() does, and Error(tracking) with the last reason when no
/// frame would do.
CalibratedPerson calibrate_file(const TrackRequest& request, const RunHooks& hooks,
                                const std::filesystem::path& file);

}  // namespace telemime
