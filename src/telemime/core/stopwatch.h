// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace telemime {

/// Measures how long the stages of a frame take. Times go to reports alone: no result depends on them.
class Stopwatch {
 public:
  /// Milliseconds since the last lap, or since the stopwatch was made.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double ms = std::chrono::duration<double, std::milli>(now - start_).count();
    start_ = now;
    return ms;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace telemime
