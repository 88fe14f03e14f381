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

/// A camera or stream that is open. All is called from one thread at a time.
struct LiveDevice {
  /// Waits for the next picture; false, or a cv::Exception, when the device has stopped. Empty when it could
  /// not be opened.
  std::function<bool()> grab;
  /// Decodes the picture that was grabbed, of any kind that to_bgr8 knows, into a Mat of its own; false, an
  /// empty picture or a cv::Exception when it is damaged.
  std::function<bool(cv::Mat&)> retrieve;
  /// When the driver got the picture that was grabbed, s of the computer's monotonic clock; may be empty.
  std::function<double()> stamp = {};
  double fps = 0.0;  ///< stated by the device, or 0
};

/// Opens the device (again). A cv::Exception from it while the source runs is an attempt that failed.
using OpenDevice = std::function<LiveDevice()>;

/// Times in seconds.
struct LiveOptions {
  /// Waits before each attempt to open a device that has stopped. After the last failed attempt the source
  /// ends, and a picture that arrives starts the list anew. A source that is attended never ends: it goes on
  /// with the last wait, and starts anew when pictures have come for `steady`.
  std::vector<double> pauses = {0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 15.0, 30.0};
  double longest_pause = 5.0;  ///< of a source that is attended
  double steady = 2.0;         ///< see pauses
  double silence = 2.0;        ///< without a picture, until an attended source says that it is gone
  /// To connect to a stream, then to wait for each of its pictures; of any device, to get the first one.
  double patience = 8.0;
  double farewell = 1.0;  ///< that the destructor waits for a device that is being read
  /// Called by the destructor when that was not enough: a thread is still within the driver, or FFmpeg. A
  /// program that ends then must not run the destructors of static objects (std::_Exit).
  std::function<void()> left_behind = {};
  Clock clock = monotonic_clock();  ///< not for waits: these end early when the source is stopped
};

/// A live source around `open`, which is called at once and, from the reader's thread, after each
/// interruption. That thread keeps only the newest frame; next() waits for one that was not handed out yet.
/// The index counts every picture that could be decoded, so gaps show dropped ones. Frame::taken is the
/// driver's stamp where that is of the monotonic clock and not older than a second, else the time when grab()
/// returned, before the picture is decoded (FFmpeg decodes all but Motion JPEG within grab()). It never goes
/// back. Exposure and the way into the driver (of a stream: the sender's side and the network) came before
/// and are not seen by any clock here. Frame::time is since the first picture. A device that hangs is left to
/// a thread of its own at the end, with all that `open` holds. Another exception than OpenCV's ends the
/// source; its words are in complaint().
/// Returns nothing when the device cannot be opened or gives no picture.
std::unique_ptr<Source> live_source(const std::string& name, OpenDevice open, LiveOptions options = {});

/// open_source with options for cameras and streams.
std::unique_ptr<Source> open_source(const std::string& input, const LiveOptions& options);

}  // namespace telemime
