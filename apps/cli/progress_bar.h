// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <string>

namespace telemime {

/// One line on standard error: progress in a file, frames per second, time left. If standard error is not a
/// terminal, a line is printed only now and then.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet) : quiet_(quiet) {}
  /// `what` comes first, for instance the file or the stage; may be empty. `total` 0: not known.
  void show(const std::string& what, std::int64_t frames, std::int64_t total, double seconds);
  /// Ends the line, so that other text can follow.
  void interrupt();

 private:
  bool quiet_;
  bool open_ = false;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace telemime
