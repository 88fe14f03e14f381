// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace telemime {

/// A clock as an argument, so that code that depends on time can be tested without waiting.
struct Clock {
  std::function<double()> now;             ///< seconds since a fixed start; never decreases
  std::function<void(double)> wait_until;  ///< returns when now() has reached this time
};

/// The monotonic clock of the computer; all copies in a program show the same time.
inline Clock monotonic_clock() {
  using Steady = std::chrono::steady_clock;
  return {[] { return std::chrono::duration<double>(Steady::now().time_since_epoch()).count(); },
          [](double seconds) {
            std::this_thread::sleep_until(Steady::time_point(
                std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(seconds))));
          }};
}

}  // namespace telemime
