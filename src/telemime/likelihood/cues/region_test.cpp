// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/cues/region.h"

#include <gtest/gtest.h>

#include "telemime/core/random.h"

namespace telemime {
namespace {

TEST(Region, IsTheMeanShareOutsideTheIntersections) {
  const auto f = [](const Reductions& r) { return non_overlapping_ratio(r); };
  EXPECT_EQ(f({{100, 50, 300}, {100, 50, 300}, {100, 50, 300}, 0.0, 0}), 0.0) << "the same planes";
  EXPECT_EQ(f({{100, 50, 300}, {10, 20, 30}, {0, 0, 0}, 0.0, 0}), 1.0) << "disjoint planes";
  // Unions 120, 60, 400; outside of the intersections 70, 20, 100: mean of 7/12, 1/3 and 1/4.
  EXPECT_NEAR(f({{100, 50, 350}, {70, 50, 350}, {50, 40, 300}, 0.0, 0}),
              (70.0 / 120 + 20.0 / 60 + 100.0 / 400) / 3, 1e-15);
  EXPECT_NEAR(f({{0, 50, 0}, {0, 50, 0}, {0, 0, 0}, 0.0, 0}), 1.0 / 3, 1e-15) << "two classes nowhere";
  EXPECT_EQ(f(Reductions{}), 0.0) << "nothing anywhere";
  EXPECT_NEAR(f({{20, 0, 0}, {0, 30, 0}, {0, 0, 0}, 0.0, 0}), 2.0 / 3, 1e-15) << "each on one side only";
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

TEST(Region, LabelsThatNoPoseExplainsCountLess) {
  EXPECT_EQ(label_reliability(0.0), 1.0);
  EXPECT_EQ(label_reliability(0.15), 1.0);
  EXPECT_DOUBLE_EQ(label_reliability(0.3), 1.0 / 16.0);
  for (double residual = 0.16; residual < 1.0; residual += 0.01) {
    EXPECT_LT(label_reliability(residual), label_reliability(residual - 0.01));
    EXPECT_GT(label_reliability(residual), 0.0);
  }
  PreparedFrame frame;
  EXPECT_EQ(reliability_of(kRegionCue, frame), 1.0);
  frame.label_reliability = 0.25;
  EXPECT_EQ(reliability_of(kRegionCue, frame), 0.25);
  frame.has_colours = false;
  EXPECT_EQ(reliability_of(kRegionCue, frame), 0.0);
}

}  // namespace
}  // namespace telemime
