// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <opencv2/core/types.hpp>
#include <optional>
#include <string>

#include "telemime/capture/source.h"

namespace telemime {

/// Reports each problem of a camera once, and its end: other image sizes, low frame rates, damaged images,
/// interruptions. Each call returns what has to be reported now. Times are seconds of one monotonic clock.
class CameraWatch {
 public:
  /// `first`: the size (pixels) to which all images are resized; `start`: time of the first image.
  CameraWatch(cv::Size first, double start) : first_(first), last_(first), start_(start), newest_(start) {}

  /// An image arrived; to be called before the other functions.
  std::optional<SourceNews> back(double taken);
  std::optional<SourceNews> size(cv::Size size);
  /// Reports fewer than 10 frames per second over two to three seconds; 12 end the problem. Gaps do not
  /// count.
  std::optional<SourceNews> rate(double taken);
  /// Reports three damaged images within two seconds; three seconds without one end the problem.
  std::optional<SourceNews> damaged(double now);
  std::optional<SourceNews> whole(double now);
  /// The device stopped; from now on, it is opened again at intervals.
  std::optional<SourceNews> stopped(double now);
  /// No image has arrived for some time.
  std::optional<SourceNews> silent();

  /// All attempts to open the device again have failed.
  void given_up(std::size_t attempts);
  /// Interruptions and numbers of damaged images, one per line.
  std::string summary() const;

 private:
  cv::Size first_;
  cv::Size last_;
  double start_;
  double newest_;  // time of the last image
  std::deque<double> taken_;
  bool few_ = false;
  std::deque<double> damages_;
  bool damage_reported_ = false;
  std::int64_t all_damaged_ = 0;
  bool stopped_ = false;
  bool gone_ = false;
  int interruptions_ = 0;
  double stopped_at_ = 0.0;
  std::string outcome_;  // result of the last interruption
};

}  // namespace telemime
