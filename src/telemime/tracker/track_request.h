// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "telemime/capture/source.h"
#include "telemime/outputs/all.h"
#include "telemime/tracker/config.h"

namespace telemime {

/// What `telemime track` is asked to do.
struct TrackRequest {
  std::string input;
  InputOptions input_options = {};  ///< what is known of the input; `mirrored` is of the background clip, too
  std::string background;           ///< person-free clip; empty: learned from the input, or done without
  std::string camera;               ///< calibration file; empty: field of view
  std::string calibration;    ///< file of `telemime calibrate`; empty: calibrate on the first good frame
  std::filesystem::path out;  ///< folder of the results; empty: no files
  std::vector<std::string> formats;  ///< empty: all
  OutputOptions output_options;
  bool overlay = true;
  std::int64_t most_frames = 0;  ///< 0: all
  std::string version;           ///< of the program that tracks, for report.json
  bool keep_pace = false;        ///< live only: fewer evaluations when time is short
  Config config;
};

}  // namespace telemime
