// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "telemime/capture/clock.h"
#include "telemime/capture/live.h"
#include "telemime/capture/source.h"

namespace telemime {

/// Repeats a file: `open` opens it again at its end. Time and index keep increasing, like those of a camera.
/// Ends if the file cannot be opened again or has no frame. Throws what the first `open` throws.
std::unique_ptr<Source> loop(std::function<std::unique_ptr<Source>()> open);

/// Makes a file behave like a camera: a frame is available from its time on (relative to the first call of
/// next), and next() returns the newest one and drops older ones. Times and indices remain those of the file,
/// so gaps in the index show dropped frames. The last frame is always returned.
std::unique_ptr<Source> pace(std::unique_ptr<Source> file, Clock clock = monotonic_clock());

/// An input of a live run.
struct LiveInput {
  std::unique_ptr<Source> source;  ///< in real time
  bool camera = false;             ///< it has no end: not a file
};

/// Opens a camera (with_camera_found), or a file as a camera (pace), which is repeated if `repeat`. Throws
/// Error(usage) if what is to be repeated is not a file; otherwise as open_source().
LiveInput open_live_input(const std::string& named, const LiveOptions& options, bool repeat);

}  // namespace telemime
