// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include "fuzz_target.h"
#include "telemime/core/time_base.h"

// The time stamps of a video: whatever they are, time increases and the rate is a number.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t kMost = 1000;
  std::vector<double> stamps(std::min(kMost, size / sizeof(double)));
  if (!stamps.empty()) {
    std::memcpy(stamps.data(), data, stamps.size() * sizeof(double));
  }
  const std::optional<double> rate = telemime::rate_of(stamps);
  if (rate && !(std::isfinite(*rate) && *rate > 0.0)) {
    std::abort();
  }
  telemime::TimeBase base(25.0);
  double last = -1.0;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    const double time =
        base.next(stamps[i], i + 1 < stamps.size() ? std::optional(stamps[i + 1]) : std::nullopt);
    if (!(time > last) || !std::isfinite(time)) {
      std::abort();
    }
    last = time;
  }
  return 0;
}
