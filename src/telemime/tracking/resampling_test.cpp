// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/resampling.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

namespace telemime {
namespace {

using Counts = std::vector<int>;
using Weights = std::vector<double>;

int sum_of(const Counts& counts) {
  return std::accumulate(counts.begin(), counts.end(), 0);
}

TEST(ProportionalCounts, GiveWholeSharesExactly) {
  EXPECT_EQ(proportional_counts(Weights{0.5, 0.25, 0.25}, 8), (Counts{4, 2, 2}));
  EXPECT_EQ(proportional_counts(Weights{1.0}, 7), (Counts{7}));
  EXPECT_EQ(proportional_counts(Weights{1, 1, 1, 1}, 4), (Counts{1, 1, 1, 1}));
}

TEST(ProportionalCounts, GiveWhatIsLeftToTheLargestFractions) {
  // 10/7, 20/7, 40/7 = 1.43, 2.86, 5.71.
  EXPECT_EQ(proportional_counts(Weights{1, 2, 4}, 10), (Counts{1, 3, 6}));
  // 3.5, 2.25, 2.25, 1 * 8/9...: 3.11, 2.67, 2.22.
  EXPECT_EQ(proportional_counts(Weights{3.5, 3.0, 2.5}, 8), (Counts{3, 3, 2}));
}

TEST(ProportionalCounts, OfEqualFractionsTheFirstComeFirst) {
  EXPECT_EQ(proportional_counts(Weights{9, 7, 4}, 10), (Counts{5, 3, 2}));
  EXPECT_EQ(proportional_counts(Weights{1, 1, 1}, 4), (Counts{2, 1, 1}));
  EXPECT_EQ(proportional_counts(Weights{1, 1, 1, 1}, 2), (Counts{1, 1, 0, 0}));
}

TEST(ProportionalCounts, WithoutWeightThereIsNoChild) {
  EXPECT_EQ(proportional_counts(Weights{0, 1, 0, 1}, 4), (Counts{0, 2, 0, 2}));
  EXPECT_EQ(proportional_counts(Weights{0, 1, 1, 1}, 4), (Counts{0, 2, 1, 1}));
  EXPECT_EQ(proportional_counts(Weights{0, 3, 0}, 5), (Counts{0, 5, 0}));
}

TEST(ProportionalCounts, AreWithinOneOfTheShareAndSumToTheTotal) {
  Random random(1);
  for (int round = 0; round < 500; ++round) {
    Weights weights(1 + random.below(40));
    for (double& w : weights) {
      w = random.uniform() < 0.3 ? 0.0 : std::pow(random.uniform(), 4.0);
    }
    weights[random.below(static_cast<std::uint32_t>(weights.size()))] = 0.1;
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    const int total = static_cast<int>(random.below(300));
    const Counts counts = proportional_counts(weights, total);
    ASSERT_EQ(sum_of(counts), total);
    for (std::size_t i = 0; i < weights.size(); ++i) {
      ASSERT_LT(std::abs(counts[i] - total * weights[i] / sum), 1.0);
      ASSERT_GE(counts[i], 0);
    }
  }
}

TEST(MultinomialCounts, SumToTheTotal) {
  Random random(2);
  for (const int total : {0, 1, 17, 1000}) {
    EXPECT_EQ(sum_of(multinomial_counts(Weights{0.2, 0.5, 0.3}, total, random)), total);
    EXPECT_EQ(multinomial_counts(Weights{2.0}, total, random), (Counts{total}));
  }
}

TEST(MultinomialCounts, AreAsOftenAsTheWeightsSay) {
  constexpr int kTotal = 100000;
  const Weights weights = {3.0, 0.0, 1.0, 4.0, 0.0};  // need not sum to 1
  Random random(3);
  const Counts counts = multinomial_counts(weights, kTotal, random);
  for (std::size_t i = 0; i < weights.size(); ++i) {
    const double p = weights[i] / 8.0;
    EXPECT_NEAR(counts[i], kTotal * p, 4.5 * std::sqrt(kTotal * p * (1.0 - p))) << i;
  }
}

TEST(MultinomialCounts, FollowTheSeed) {
  const Weights weights = {1, 2, 3, 4};
  const auto drawn = [&](std::uint64_t seed) {
    Random random(seed);
    return multinomial_counts(weights, 1000, random);
  };
  EXPECT_EQ(drawn(4), drawn(4));
  EXPECT_NE(drawn(4), drawn(5));
}

}  // namespace
}  // namespace telemime
