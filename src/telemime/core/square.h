// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime {

/// The number times itself, for numbers that are long to write.
constexpr double square(double x) {
  return x * x;
}

}  // namespace telemime
