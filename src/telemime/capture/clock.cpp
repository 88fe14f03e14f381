// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/clock.h"

#include <chrono>
#include <thread>

namespace telemime {

Clock monotonic_clock() {
  using Steady = std::chrono::steady_clock;
  return {[] { return std::chrono::duration<double>(Steady::now().time_since_epoch()).count(); },
          [](double seconds) {
            std::this_thread::sleep_until(Steady::time_point(
                std::chrono::duration_cast<Steady::duration>(std::chrono::duration<double>(seconds))));
          }};
}

}  // namespace telemime
