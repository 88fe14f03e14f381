// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <deque>
#include <opencv2/core/types.hpp>
#include <optional>
#include <string>

#include "telemime/capture/source.h"

namespace telemime {

/// Says once, in words, what gets worse with a camera and when it is over: other sizes, few pictures a
/// second, damage, interruptions. Each call returns what is to be told now. Times in seconds of one clock,
/// which never goes back.
class CameraWatch {
 public:
  /// `first`: the size (pixels) to which all pictures are brought; `start`: time of the first.
  CameraWatch(cv::Size first, double start) : first_(first), last_(first), start_(start), newest_(start) {}

  /// A picture came: to be asked first, as it ends what was gone.
  std::optional<SourceNews> back(double taken);
  std::optional<SourceNews> size(cv::Size size);
  /// Fewer than 10 a second over two to three seconds are few; 12 are enough again. Gaps do not count.
  std::optional<SourceNews> rate(double taken);
  /// Three damaged pictures within two seconds are told; three seconds without one end it.
  std::optional<SourceNews> damaged(double now);
  std::optional<SourceNews> whole(double now);
  /// The device stopped; it is tried again from now on.
  std::optional<SourceNews> stopped(double now);
  /// No picture for some time.
  std::optional<SourceNews> silent();

  /// The attempts to open it again are over.
  void given_up(std::size_t attempts);
  /// One a line: interruptions, damaged pictures.
  std::string summary() const;

 private:
  cv::Size first_;
  cv::Size last_;
  double start_;
  double newest_;  // the last picture's time
  std::deque<double> taken_;
  bool few_ = false;
  std::deque<double> damages_;
  bool damage_told_ = false;
  std::int64_t all_damaged_ = 0;
  bool stopped_ = false;
  bool gone_ = false;
  int interruptions_ = 0;
  double stopped_at_ = 0.0;
  std::string outcome_;  // of the last interruption
};

}  // namespace telemime
