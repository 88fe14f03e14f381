// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace telemime {

/// x squared, for expressions that would have to be written twice.
constexpr double square(double x) {
  return x * x;
}

}  // namespace telemime
