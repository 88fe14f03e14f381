// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/filter_sweep.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lab/experiments/lab.h"
#include "lab/experiments/testing_sequence.h"

namespace telemime {
namespace {

FilterSetup small(FilterSetup setup) {
  setup.filter.particles = 60;
  setup.filter.mode_least = 20;
  setup.filter.mode_most = 40;
  return setup;
}

TEST(TrackFilter, SameSeedSameTraceInParallel) {
  const PreparedSequence sequence = testing::model_sequence();
  for (const FilterSetup& setup : {small(reference_setup(kAllTogether)), small(our_setup())}) {
    const Trace alone = track_filter(sequence, setup, 3);
    std::vector<Trace> beside(4);
    longest_first(std::vector<double>(beside.size(), 1.0),
                  [&](std::size_t i) { beside[i] = track_filter(sequence, setup, i < 3 ? 3 : 4); });
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_EQ(beside[i].error_3d, alone.error_3d);
      EXPECT_EQ(beside[i].contour, alone.contour);
      EXPECT_EQ(beside[i].jitter, alone.jitter);
    }
    EXPECT_NE(beside[3].error_3d, alone.error_3d);
  }
}

TEST(TrackFilter, EachCueChangesTheResult) {
  const PreparedSequence sequence = testing::model_sequence();
  for (const FilterSetup& setup : {small(reference_setup(kAllTogether)), small(our_setup())}) {
    const Trace all = track_filter(sequence, setup, 3);
    for (std::size_t i = 0; i < setup.cues.size(); ++i) {
      if (reliability_of(setup.cues[i], sequence.frames.front()) == 0.0) {
        continue;  // no networks have looked at these frames
      }
      FilterSetup less = setup;
      less.cues.enable(i, false);
      const Trace without = track_filter(sequence, less, 3);
      EXPECT_NE(without.error_3d, all.error_3d) << setup.cues[i].name;
      ASSERT_EQ(without.region.size(), all.region.size());
      EXPECT_GT(without.region[1], 0.0) << "a disabled cue is still measured";
    }
  }
}

TEST(TrackFilter, MeasuresEveryFrame) {
  const PreparedSequence sequence = testing::model_sequence();
  const FilterSetup setup = small(reference_setup(kCondensation));
  const Trace trace = track_filter(sequence, setup, 1);
  ASSERT_EQ(trace.frame.size(), 3U);
  EXPECT_EQ(trace.evaluations, std::vector<double>(3, 60.0));
  ASSERT_EQ(trace.effective.size(), 3U);
  for (const double effective : trace.effective) {
    EXPECT_GE(effective, 1.0);
    EXPECT_LE(effective, 60.0);
  }
  EXPECT_EQ(trace.moving, std::vector<double>(3, 1.0));
  EXPECT_GT(trace.jitter, 0.0);
}

TEST(Setups, HaveTheNamesOfTheLab) {
  EXPECT_EQ(filter_setup(kCondensation).filter.heuristics, "");
  EXPECT_EQ(filter_setup("kf").filter.heuristics, "kf");
  EXPECT_EQ(filter_setup("kf").velocity, 0.0);
  EXPECT_FALSE(filter_setup(kAllTogether).filter.blocks);
  EXPECT_EQ(filter_setup(kOurFilter).filter.heuristics, FilterConfig{}.heuristics);
  EXPECT_GT(filter_setup(kOurFilter).velocity, 0.0);
}

TEST(CountMistracked, TakesPeaksOfEitherOnce) {
  Trace trace;
  trace.region = {0.1, 0.4, 0.1, 0.4};
  trace.contour = {1.0, 1.0, 3.0, 3.0};
  EXPECT_EQ(count_mistracked(trace, {0.3, 2.5}), 3U);
}

TEST(SpreadOf, IsMeanLowestAndHighestOfWhatIsFinite) {
  const Spread spread = spread_of(std::vector<double>{4.0, std::nan(""), 1.0, 4.0});
  EXPECT_EQ(spread.mean, 3.0);
  EXPECT_EQ(spread.low, 1.0);
  EXPECT_EQ(spread.high, 4.0);
  EXPECT_EQ(mean_and_range(spread), "3 (1 to 4)");
  EXPECT_TRUE(std::isnan(spread_of({}).low));
}

// Error of a run: 100 for each sequence, plus particles, plus the seed.
FilterSweep counted_sweep(const std::vector<int>& particles) {
  return sweep<FilterRun>(
      std::vector{0.0, 5.0}, particles, 7, 3, [](std::size_t s, int count, std::uint64_t seed) {
        return FilterRun{100.0 * static_cast<double>(s) + count + static_cast<double>(seed)};
      });
}

TEST(Sweep, PutsEveryRunInItsPlace) {
  const FilterSweep result = counted_sweep({10, 30});
  EXPECT_EQ(result.run(0, 0, 0).error_3d, 17.0);
  EXPECT_EQ(result.run(1, 1, 2).error_3d, 139.0);
  const Spread spread = result.at(1, 0, &FilterRun::error_3d);
  EXPECT_EQ(spread.mean, 118.0);
  EXPECT_EQ(spread.low, 117.0);
  EXPECT_EQ(spread.high, 119.0);
  EXPECT_EQ(spread.width(), 2.0);
  EXPECT_EQ(result.over_sequences(1, &FilterRun::error_3d).low, 87.0);
  EXPECT_EQ(result.mean_of_sequence(0, &FilterRun::error_3d), 28.0);
  EXPECT_EQ(result.mean_of_all(&FilterRun::error_3d), 78.0);
}

TEST(AveragesOf, AddUpSpreadAndRises) {
  const FilterAverages up = averages_of(counted_sweep({10, 30, 20}), &FilterRun::error_3d);
  EXPECT_EQ(up.gestures, (std::vector<double>{28.0, 128.0}));
  EXPECT_EQ(up.all, 78.0);
  EXPECT_EQ(up.spread, 2.0);
  EXPECT_EQ(up.rises, 20.0);
  // The seeds give -1, 0 and 1 around the mean, each for three numbers of particles.
  EXPECT_NEAR(up.chance[1], 2.0 / 3.0, 1e-9);
  EXPECT_NEAR(up.chance_of_all, 2.0 / 3.0 / std::sqrt(2.0), 1e-9);
}

TEST(ChangeOf, SeparatesAChangeFromChance) {
  const FilterAverages a{{10.0, 10.0, 10.0}, 10.0, {3.0, 3.0, 3.0}, 1.0};
  const FilterAverages b{{4.0, 14.0, 16.0}, 12.0, {4.0, 4.0, 4.0}, 1.0};
  EXPECT_EQ(change_of(a, b, 0), -1);
  EXPECT_EQ(change_of(a, b, 1), 0);
  EXPECT_EQ(change_of(a, b, 2), 1);
  EXPECT_EQ(change_of_all(a, b), 1);
}

TEST(LongestFirst, DoesAllOnce) {
  std::vector<int> done(20);
  std::vector<double> lengths;
  for (int i = 0; i < 20; ++i) {
    lengths.push_back(i % 7);
  }
  longest_first(lengths, [&](std::size_t i) { ++done[i]; });
  EXPECT_EQ(done, std::vector<int>(20, 1));
}

}  // namespace
}  // namespace telemime
