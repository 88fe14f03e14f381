// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/cues/region.h"

#include <gtest/gtest.h>

#include "telemime/core/random.h"

namespace telemime {
namespace {

TEST(Region, IsZeroForTheSamePlanes) {
  EXPECT_EQ(non_overlapping_ratio({{100, 50, 300}, {100, 50, 300}, {100, 50, 300}, 0.0, 0}), 0.0);
}

TEST(Region, IsOneForDisjointPlanes) {
  EXPECT_EQ(non_overlapping_ratio({{100, 50, 300}, {10, 20, 30}, {0, 0, 0}, 0.0, 0}), 1.0);
}

TEST(Region, CountsAsByHand) {
  // Unions 120, 60, 400; outside of the intersections 70, 20, 100: mean of 7/12, 1/3 and 1/4.
  const Reductions r = {{100, 50, 350}, {70, 50, 350}, {50, 40, 300}, 0.0, 0};
  EXPECT_NEAR(non_overlapping_ratio(r), (70.0 / 120 + 20.0 / 60 + 100.0 / 400) / 3, 1e-15);
}

TEST(Region, ClassThatIsNowhereCountsZero) {
  EXPECT_NEAR(non_overlapping_ratio({{0, 50, 0}, {0, 50, 0}, {0, 0, 0}, 0.0, 0}), 1.0 / 3, 1e-15);
  EXPECT_EQ(non_overlapping_ratio(Reductions{}), 0.0);
}

TEST(Region, ClassOnOneSideOnlyCountsOne) {
  EXPECT_NEAR(non_overlapping_ratio({{20, 0, 0}, {0, 30, 0}, {0, 0, 0}, 0.0, 0}), 2.0 / 3, 1e-15);
}

TEST(Region, StaysBetweenZeroAndOneAndIsSymmetric) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    Reductions r;
    for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
      r.observed[c] = static_cast<int>(random.below(1000));
      r.model[c] = static_cast<int>(random.below(1000));
      const auto most = static_cast<std::uint32_t>(std::min(r.observed[c], r.model[c]));
      r.both[c] = static_cast<int>(random.below(most + 1));
    }
    const double f = non_overlapping_ratio(r);
    ASSERT_GE(f, 0.0);
    ASSERT_LE(f, 1.0);
    std::swap(r.observed, r.model);
    ASSERT_EQ(non_overlapping_ratio(r), f);
  }
}

}  // namespace
}  // namespace telemime
