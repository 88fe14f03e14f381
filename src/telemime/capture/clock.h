// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

namespace telemime {

/// A clock as an argument, so that code that depends on time can be tested without waiting.
struct Clock {
  std::function<double()> now;             ///< seconds since a fixed start; never decreases
  std::function<void(double)> wait_until;  ///< returns when now() has reached this time
};

/// The monotonic clock of the computer; all copies in a program show the same time.
Clock monotonic_clock();

}  // namespace telemime
