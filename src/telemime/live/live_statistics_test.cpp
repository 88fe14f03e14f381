// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/live_statistics.h"

#include <gtest/gtest.h>

#include <limits>

namespace telemime {
namespace {

FrameTimes at(std::int64_t index, double taken) {
  return {index, taken, taken + 0.001, taken + 0.010, taken + 0.012, taken + 0.034, 6.0};
}

TEST(UsableStamp, IsTheSourcesWhereItCanBe) {
  EXPECT_EQ(usable_stamp(99.5, 99.0, 100.0), 99.5);
  EXPECT_EQ(usable_stamp(100.0, 99.0, 100.0), 100.0);
}

TEST(UsableStamp, OddOnesDoNoHarm) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  for (const double odd : {0.0, -5.0, 101.0, 1.7e9, kInf, -kInf, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_EQ(usable_stamp(odd, 99.0, 100.0), 100.0) << odd;
  }
  EXPECT_EQ(usable_stamp(98.0, 99.0, 100.0), 99.0) << "it does not go back";
}

TEST(Quantile, OfFewValues) {
  EXPECT_EQ(quantile_of({}, 0.5), 0.0);
  EXPECT_EQ(quantile_of({3.0}, 0.95), 3.0);
  EXPECT_EQ(quantile_of({5.0, 1.0, 3.0}, 0.5), 3.0);
  EXPECT_EQ(quantile_of({5.0, 1.0, 3.0}, 1.0), 5.0);
  EXPECT_EQ(quantile_of({5.0, 1.0, 3.0}, 0.0), 1.0);
}

TEST(LiveStatistics, CountsRatesAndDroppedFrames) {
  LiveStatistics statistics;
  for (int i = 0; i <= 50; ++i) {
    statistics.add(at(2 * i, 0.04 * 2 * i));  // every other frame of a camera of 25 a second
  }
  const LiveRates rates = statistics.rates(4.01);
  EXPECT_NEAR(rates.input, 25.0, 1e-9);
  EXPECT_NEAR(rates.tracked, 12.5, 1e-9);
  EXPECT_EQ(rates.dropped, 50);
  EXPECT_EQ(rates.frames, 51);
  EXPECT_NEAR(rates.ms.wait, 1.0, 1e-6);
  EXPECT_NEAR(rates.ms.features, 9.0, 1e-6);
  EXPECT_NEAR(rates.ms.networks, 6.0, 1e-6);
  EXPECT_NEAR(rates.ms.queue, 2.0, 1e-6);
  EXPECT_NEAR(rates.ms.search, 22.0, 1e-6);
  EXPECT_NEAR(rates.ms.total, 34.0, 1e-6);
}

TEST(LiveStatistics, TimesThatAlternateHaveTheirMiddle) {
  LiveStatistics statistics;
  for (int i = 0; i <= 10; ++i) {
    FrameTimes times = at(i, 0.04 * i);
    times.networks_ms = i % 2 == 0 ? 10.0 : 16.0;
    statistics.add(times);
    EXPECT_NEAR(statistics.rates(0.04 * i).ms.networks, i == 0 ? 10.0 : 13.0, 1e-6);
  }
}

TEST(LiveStatistics, ACameraThatStoppedHasNoRate) {
  LiveStatistics statistics;
  EXPECT_EQ(statistics.rates(0.0).input, 0.0);
  statistics.add(at(0, 0.0));
  statistics.add(at(1, 0.04));
  EXPECT_GT(statistics.rates(1.0).input, 0.0);
  EXPECT_EQ(statistics.rates(5.0).input, 0.0);
}

TEST(LiveStatistics, AnInterruptionDoesNotCountIntoTheRates) {
  LiveStatistics statistics;
  for (int i = 0; i <= 20; ++i) {
    statistics.add(at(i, 0.04 * i));
  }
  const double back = 600.0;  // ten minutes later
  for (int i = 0; i <= 20; ++i) {
    statistics.add(at(21 + i, back + 0.04 * i));
  }
  const LiveRates rates = statistics.rates(back + 0.9);
  EXPECT_NEAR(rates.input, 25.0, 1e-9);
  EXPECT_NEAR(rates.tracked, 25.0, 1e-9);
  EXPECT_EQ(rates.frames, 42);
  EXPECT_EQ(rates.dropped, 0);
}

TEST(LiveStatistics, ATrackerThatIsSlowHasARate) {
  LiveStatistics statistics;
  for (int i = 0; i <= 10; ++i) {
    statistics.add(at(100 * i, 4.0 * i));  // one frame in four seconds, of a camera of 25 a second
  }
  EXPECT_NEAR(statistics.rates(40.1).tracked, 0.25, 1e-9);
  EXPECT_NEAR(statistics.rates(40.1).input, 25.0, 1e-9);
}

TEST(LatencyRecord, LeavesOutWhatNoPageCanHaveMeasured) {
  LatencyRecord record;
  EXPECT_FALSE(record.summary());
  record.add(-1.0);
  record.add(std::numeric_limits<double>::quiet_NaN());
  record.add(1e9);
  EXPECT_FALSE(record.summary());
  record.add(60.0);
  ASSERT_TRUE(record.summary());
  EXPECT_EQ(record.summary()->median, 60.0);
}

TEST(LatencyRecord, ForgetsTheOldest) {
  LatencyRecord record;
  for (int i = 0; i < 1000; ++i) {
    record.add(i < 500 ? 1000.0 : 50.0);
  }
  EXPECT_EQ(record.summary()->p95, 50.0);
}

TEST(InputRate, IsTheTimeStampsWhereTheyContradict) {
  const auto believed = [](double stated, double actual, int frames) {
    InputRate rate;
    for (int i = 0; i < frames; ++i) {
      rate.add(i, i / actual);
    }
    return rate.believable(stated);
  };
  EXPECT_NEAR(believed(1000.0, 25.0, 50), 25.0, 1e-9) << "a clock rate";
  EXPECT_NEAR(believed(25.0, 30.0, 60), 30.0, 1e-9);
  EXPECT_EQ(believed(30.0, 20.0, 60), 30.0) << "slow in dim light";
  EXPECT_NEAR(believed(30.0, 10.0, 60), 10.0, 1e-9);
  EXPECT_EQ(believed(30.0, 2.0, 3), 30.0) << "too few frames";
  EXPECT_EQ(believed(30.0, 1000.0, 100), 30.0) << "too short a time";
}

TEST(InputRate, AnInterruptionDoesNotCount) {
  InputRate rate;
  double time = 0.0;
  for (int i = 0; i < 600; ++i) {
    rate.add(i, time);
    time += i == 400 ? 60.0 : 1.0 / 30.0;
  }
  EXPECT_EQ(rate.believable(30.0), 30.0);
}

TEST(LiveStatistics, ImageSideFallsBehindTheCamera) {
  FrameTimes before{.index = 3, .taken = 1.0, .begun = 1.0, .seen = 1.02};
  EXPECT_FALSE(falls_behind({.index = 4, .taken = 1.04, .begun = 1.04, .seen = 1.07}, before));
  EXPECT_EQ(before.index, 4);
  EXPECT_TRUE(falls_behind({.index = 6, .taken = 1.12, .begun = 1.12, .seen = 1.17}, before))
      << "50 of 40 ms";
  EXPECT_FALSE(falls_behind({.index = 6, .taken = 1.12, .begun = 1.12, .seen = 1.17}, before))
      << "no new frame";
}

}  // namespace
}  // namespace telemime
