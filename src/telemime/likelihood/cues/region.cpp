// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/cues/region.h"

namespace telemime {

double non_overlapping_ratio(const Reductions& r) {
  double sum = 0.0;
  for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
    const int either = r.observed[c] + r.model[c] - r.both[c];
    if (either > 0) {
      sum += static_cast<double>(either - r.both[c]) / either;
    }
  }
  return sum / static_cast<double>(kSurfaceClassCount);
}

}  // namespace telemime
