// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace telemime {

/// Time on the wall, s, from some moment on: for what uses several threads or a device.
inline double wall_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace telemime
