// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace telemime {

/// Time as an argument, so that what depends on it can be tested without waiting.
struct Clock {
  std::function<double()> now;             ///< seconds from some fixed start; never goes back
  std::function<void(double)> wait_until;  ///< returns when now() has reached this many seconds
};

/// The computer's monotonic clock: all of them in one program show the same time.
Clock monotonic_clock();

}  // namespace telemime
