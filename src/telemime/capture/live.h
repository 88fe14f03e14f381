// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "telemime/capture/clock.h"
#include "telemime/capture/source.h"

namespace telemime {

/// A camera or stream that is open. Reads the next picture (any kind that to_bgr8 knows) into the argument
/// and returns true; false when the device has stopped. May block.
using Grab = std::function<bool(cv::Mat&)>;

struct LiveDevice {
  Grab grab;         ///< empty when the device could not be opened
  double fps = 0.0;  ///< stated by the device, or 0
};

/// Opens the device (again).
using OpenDevice = std::function<LiveDevice()>;

struct LiveOptions {
  /// Seconds to wait before each attempt to open a device that has stopped. After the last failed attempt the
  /// source ends; a picture that arrives starts the list anew.
  std::vector<double> pauses = {0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 15.0, 30.0};
  Clock clock = monotonic_clock();  ///< for time stamps only; pauses end early when the source is destroyed
};

/// A live source around `open`, which is called at once and, from the reader's thread, after each
/// interruption. That thread keeps only the newest frame; next() waits for one that was not handed out yet.
/// Time stamps are seconds of the clock since the first picture; the index counts every picture, so gaps show
/// dropped ones. Returns nothing when the device cannot be opened or gives no picture.
std::unique_ptr<Source> live_source(const std::string& name, OpenDevice open, LiveOptions options = {});

}  // namespace telemime
