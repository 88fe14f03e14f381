// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "telemime/capture/clock.h"
#include "telemime/capture/source.h"

namespace telemime {

/// An open camera or stream. Its functions are called from one thread at a time.
struct LiveDevice {
  /// Waits for the next image; false, or a cv::Exception, if the device has stopped. Empty if it could not be
  /// opened.
  std::function<bool()> grab;
  /// Decodes the grabbed image into a new Mat, of any type that to_bgr8 accepts; false, an empty image or a
  /// cv::Exception if it is damaged.
  std::function<bool(cv::Mat&)> retrieve;
  /// Time at which the driver received the grabbed image, s of the computer's monotonic clock; may be empty.
  std::function<double()> stamp = {};
  double fps = 0.0;  ///< stated by the device, or 0
};

/// Opens the device, also again. A cv::Exception during a run counts as a failed attempt.
using OpenDevice = std::function<LiveDevice()>;

/// Options of live sources. Times in seconds.
struct LiveOptions {
  /// Pauses before the attempts to open a device that has stopped. The source ends after the last failed
  /// attempt; an image that arrives restarts the list. An attended source never ends: it repeats the longest
  /// pause, and restarts the list when images have arrived for `steady`.
  std::vector<double> pauses = {0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 15.0, 30.0};
  double longest_pause = 5.0;  ///< of an attended source
  double steady = 2.0;         ///< see pauses
  double silence = 2.0;        ///< without an image, until an attended source reports that it is gone
  /// Time-out for connecting to a stream, for each of its images, and for the first image of any device.
  double patience = 8.0;
  double farewell = 1.0;  ///< how long the destructor waits for a device that is being read
  /// Called by the destructor if that was too short: a thread is still inside the driver or FFmpeg. A program
  /// that ends then must not run the destructors of static objects (std::_Exit).
  std::function<void()> left_behind = {};
  InputOptions input = {};
  Clock clock = monotonic_clock();  ///< not used for pauses, which end early when the source is stopped
};

/// A live source that reads a device in a thread of its own. `open` is called at once, and by that thread
/// after each interruption. The thread keeps only the newest frame; next() waits for one that was not
/// returned yet. The index counts all images that could be decoded, so gaps show dropped ones. Frame::taken
/// is the time stamp of the driver if that is of the monotonic clock and at most a second old, otherwise the
/// time at which grab() returned, before the image was decoded (FFmpeg decodes all but Motion JPEG within
/// grab()). It never decreases. It does not include exposure and the transfer to the driver (for a stream:
/// the sender and the network). Frame::time is relative to the first image. A device that hangs at the end is
/// left to its thread, with everything that `open` holds. An exception that is not OpenCV's ends the source;
/// complaint() has its message. Returns null if the device cannot be opened or delivers no image.
std::unique_ptr<Source> live_source(const std::string& name, OpenDevice open, LiveOptions options = {});

/// Like open_source(input), with options for cameras and streams.
std::unique_ptr<Source> open_source(const std::string& input, const LiveOptions& options);

}  // namespace telemime
