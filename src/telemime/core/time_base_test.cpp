// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/time_base.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "telemime/core/random.h"

namespace telemime {
namespace {

std::vector<double> stamps(int count, double fps) {
  std::vector<double> all;
  for (int i = 0; i < count; ++i) {
    all.push_back(7.0 + i / fps);
  }
  return all;
}

TEST(RateOf, RegularStampsGiveTheirRate) {
  for (const double fps : {1.0, 12.5, 19.0, 25.0, 30000.0 / 1001.0, 119.881, 240.0}) {
    EXPECT_NEAR(*rate_of(stamps(50, fps)), fps, 0.01 * fps) << fps;
  }
  EXPECT_FALSE(rate_of({}));
  EXPECT_FALSE(rate_of({0.0, 0.04}));
  EXPECT_FALSE(rate_of({0.0, 0.0, 0.0, 0.0}));
  EXPECT_FALSE(rate_of({0.0, 1e-320, 2e-320, 3e-320})) << "no rate is infinite";
  EXPECT_FALSE(rate_of({-1e300, 0.0, 1e300, 1.7e308}));
}

TEST(RateOf, RoundingToMillisecondsDoesNotMatter) {
  for (const double fps : {25.0, 30.0, 60.0, 75.0, 120.0, 240.0}) {
    std::vector<double> all = stamps(60, fps);
    for (double& stamp : all) {
      stamp = std::round(1000.0 * stamp) / 1000.0;
    }
    EXPECT_NEAR(*rate_of(all), fps, 0.01 * fps) << fps;
  }
}

TEST(RateOf, JitterDoesNotMatter) {
  Random random(3);
  std::vector<double> all = stamps(120, 25.0);
  for (double& stamp : all) {
    stamp += 0.03 * random.uniform();
  }
  EXPECT_EQ(*rate_of(all), 25.0);
}

TEST(RateOf, LeftOutFramesAndPausesDoNotMatter) {
  std::vector<double> all;
  for (int i = 0; i < 100; ++i) {
    if (i % 4 != 2) {
      all.push_back(i / 25.0 + (i > 50 ? 15.0 : 0.0));
    }
  }
  EXPECT_EQ(*rate_of(all), 25.0);
}

TEST(RateOf, BurstsHaveTheMeanRate) {
  std::vector<double> all;
  for (int i = 0; i < 100; ++i) {
    const int pair = i / 2;
    all.push_back(0.08 * pair + 0.001 * (i % 2));
  }
  EXPECT_EQ(*rate_of(all), 25.0);
}

TEST(TimeBase, TimeIsThatOfTheStamps) {
  Random random(1);
  TimeBase base(25.0);
  double stamp = 100.0;
  EXPECT_EQ(base.next(stamp), 0.0);
  for (int i = 0; i < 200; ++i) {
    stamp += 0.002 + random.uniform() * (i % 50 == 0 ? 60.0 : 0.1);
    EXPECT_NEAR(base.next(stamp, stamp + 0.04), stamp - 100.0, 1e-9) << i;
  }
}

TEST(TimeBase, FramesWithoutAStampFollowAtTheRate) {
  TimeBase base(20.0);
  const std::optional<double> none;
  EXPECT_EQ(base.next(none), 0.0);
  EXPECT_NEAR(base.next(none), 0.05, 1e-12);
  EXPECT_NEAR(base.next(std::numeric_limits<double>::quiet_NaN()), 0.1, 1e-12);
  EXPECT_NEAR(base.next(3.0), 0.15, 1e-12) << "the first stamp";
  EXPECT_NEAR(base.next(3.05), 0.2, 1e-12);
}

TEST(TimeBase, TimeIncreasesWhateverTheStamps) {
  Random random(2);
  for (int round = 0; round < 50; ++round) {
    TimeBase base(25.0);
    double last = -1.0;
    for (int i = 0; i < 50; ++i) {
      const double time = base.next(std::pow(10.0, 9.0 * random.uniform() - 3.0) * (random.uniform() - 0.5));
      EXPECT_GT(time, last);
      EXPECT_LT(time, 3601.0 * (i + 1));
      last = time;
    }
  }
}

// The time of each frame, with the stamp of the next one known.
std::vector<double> times_of(const std::vector<double>& all, double fps) {
  TimeBase base(fps);
  std::vector<double> times;
  for (std::size_t i = 0; i < all.size(); ++i) {
    times.push_back(base.next(all[i], i + 1 < all.size() ? std::optional(all[i + 1]) : std::nullopt));
  }
  return times;
}

TEST(TimeBase, OneWrongStampIsNotBelieved) {
  Random random(4);
  for (int round = 0; round < 300; ++round) {
    const double fps = round % 2 == 0 ? 25.0 : 119.881;
    std::vector<double> all = stamps(60, fps);
    const std::vector<double> right = times_of(all, fps);
    const auto which = static_cast<std::size_t>(2 + random.uniform() * 57.0);
    const double off = std::pow(10.0, 5.0 * random.uniform() + 1.8);
    all[which] += round % 3 == 0 ? -off : off;
    const std::vector<double> times = times_of(all, fps);
    for (std::size_t i = 0; i < times.size(); ++i) {
      EXPECT_NEAR(times[i], right[i], 1e-6) << round << " " << i << ": " << off << " s at " << which;
    }
  }
}

TEST(TimeBase, APauseThatTheNextFrameConfirmsCounts) {
  for (const double pause : {0.6, 15.0, 70.0, 3000.0}) {
    std::vector<double> all = stamps(20, 25.0);
    for (std::size_t i = 10; i < all.size(); ++i) {
      all[i] += pause;
    }
    EXPECT_NEAR(times_of(all, 25.0).back(), 19 / 25.0 + pause, 1e-9);
    // Before the last frame, nothing confirms it.
    all.resize(11);
    EXPECT_NEAR(times_of(all, 25.0).back(), 10 / 25.0 + (pause > 60.0 ? 0.0 : pause), 1e-9);
  }
}

TEST(TimeBase, JoinedRecordingsGoOnAtTheRate) {
  TimeBase base(25.0);
  base.next(0.0);
  EXPECT_NEAR(base.next(9.0), 9.0, 1e-12);
  EXPECT_NEAR(base.next(1.0), 9.04, 1e-12) << "the second one begins";
  EXPECT_NEAR(base.next(1.04), 9.08, 1e-12);
  EXPECT_NEAR(base.next(95000.0), 9.12, 1e-12) << "a counter that ran over";
}

}  // namespace
}  // namespace telemime
