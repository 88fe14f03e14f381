// SPDX-License-Identifier: Apache-2.0
// A cue is a cost of what a back end counts. This one looks at the arms alone.
// Usage: 03_add_a_cue
#include <cstdio>

#include "telemime/likelihood/cues/all.h"

namespace {

double arms_only(const telemime::Reductions& r, double) {
  constexpr auto kArms = static_cast<std::size_t>(telemime::SurfaceClass::arms) - 1;
  const int either = r.observed[kArms] + r.model[kArms] - r.both[kArms];
  return either > 0 ? static_cast<double>(either - r.both[kArms]) / either : 0.0;
}

constexpr telemime::Cue kArmsCue = {"arms", "ratio", telemime::Reduction::overlap, arms_only};

}  // namespace

int main() {
  telemime::Reductions counts;
  counts.observed = {400, 300, 2000};
  counts.model = {420, 280, 2100};
  counts.both = {390, 200, 1950};
  for (const telemime::Cue& cue : telemime::kCues) {
    std::printf("%-8s %.3f %s\n", cue.name.data(), cue.cost(counts, 10.0), cue.unit.data());
  }
  std::printf("%-8s %.3f %s\n", kArmsCue.name.data(), kArmsCue.cost(counts, 10.0), kArmsCue.unit.data());
  return 0;
}
