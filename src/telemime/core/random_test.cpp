// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/random.h"

#include <gtest/gtest.h>

#include <cmath>

namespace telemime {
namespace {

TEST(Random, SameSeedSameNumbers) {
  Random a(7, 3);
  Random b(7, 3);
  for (int i = 0; i < 100; ++i) {
    ASSERT_EQ(a.bits(), b.bits());
  }
}

TEST(Random, StreamsAndSeedsDiffer) {
  EXPECT_NE(Random(7, 0).bits(), Random(7, 1).bits());
  EXPECT_NE(Random(7, 0).bits(), Random(8, 0).bits());
}

TEST(Random, MomentsOfTheDistributions) {
  Random random(1);
  const int n = 200000;
  double mean = 0.0;
  double square = 0.0;
  double uniform = 0.0;
  int below = 0;
  for (int i = 0; i < n; ++i) {
    const double x = random.normal(2.0, 3.0);
    mean += x / n;
    square += (x - 2.0) * (x - 2.0) / n;
    const double u = random.uniform(-1.0, 3.0);
    ASSERT_GE(u, -1.0);
    ASSERT_LT(u, 3.0);
    uniform += u / n;
    const auto k = random.below(5);
    ASSERT_LT(k, 5U);
    below += k == 2 ? 1 : 0;
  }
  EXPECT_NEAR(mean, 2.0, 0.03);
  EXPECT_NEAR(std::sqrt(square), 3.0, 0.03);
  EXPECT_NEAR(uniform, 1.0, 0.01);
  EXPECT_NEAR(below / static_cast<double>(n), 0.2, 0.005);
}

}  // namespace
}  // namespace telemime
