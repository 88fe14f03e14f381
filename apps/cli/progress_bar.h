// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>

namespace telemime {

/// One line on standard error: how far a file is, frames a second, time left. Silent when standard error is
/// not a terminal, except for a line now and then.
class ProgressBar {
 public:
  explicit ProgressBar(bool quiet) : quiet_(quiet) {}
  void show(std::int64_t frames, std::int64_t total, double seconds);
  /// Ends the line, so that other words can follow.
  void interrupt();

 private:
  bool quiet_;
  bool open_ = false;
  std::chrono::steady_clock::time_point last_;
};

}  // namespace telemime
