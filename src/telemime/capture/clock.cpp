// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/clock.h"

#include <chrono>
#include <thread>

namespace telemime {

Clock monotonic_clock() {
  using Steady = std::chrono::steady_clock;
  const Steady::time_point start = Steady::now();
  return {[start] { return std::chrono::duration<double>(Steady::now() - start).count(); },
          [start](double seconds) {
            std::this_thread::sleep_until(
                start + std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(seconds)));
          }};
}

}  // namespace telemime
