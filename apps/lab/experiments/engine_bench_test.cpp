// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/engine_bench.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

// A clock that the test advances.
struct Clock {
  double now = 0.0;
  std::function<double()> function() {
    return [this] { return now; };
  }
};

// Takes 1 ms for a batch and 2 us for each pose, but the first batch takes long.
class Timed final : public Backend {
 public:
  explicit Timed(Clock& clock) : clock_(&clock) {}
  std::string_view name() const override { return "timed"; }
  void count(const PreparedFrame&, const Model&, std::span<const Pose> poses, Reduction,
             std::span<Reductions> counts) override {
    EXPECT_EQ(poses.size(), counts.size());
    const double noise = 1e-4 * static_cast<double>((7 * batches_) % 5);
    clock_->now += (batches_ == 0 ? 1.0 : 0.0) + 1e-3 + noise + 2e-6 * static_cast<double>(poses.size());
    device_ = {noise, 1e-3, 1e-6};
    ++batches_;
  }
  std::optional<DeviceTimes> device_times() const override { return device_; }
  int batches() const { return batches_; }

 private:
  Clock* clock_;
  DeviceTimes device_;
  int batches_ = 0;
};

TEST(BestBatchTime, IsTheBestAfterAWarmUp) {
  Clock clock;
  Timed backend(clock);
  const EngineScene scene = engine_scene(engine_cameras().front(), 250, 1);
  // Batches that fill the scene's poses unevenly.
  const BatchTime time = best_batch_time(backend, scene, 100, Reduction::all, 0.1, clock.function());
  EXPECT_NEAR(time.seconds, 1.2e-3, 1e-12);
  ASSERT_TRUE(time.device.has_value());
  EXPECT_EQ(time.device->upload, 0.0);
  EXPECT_GT(backend.batches(), 10);
  EXPECT_LT(clock.now, 1.2);
}

TEST(BestBatchTime, MeasuresLongOnesTwice) {
  Clock clock;
  Timed backend(clock);
  const EngineScene scene = engine_scene(engine_cameras().front(), 10, 1);
  best_batch_time(backend, scene, 10, Reduction::all, 0.0, clock.function());
  EXPECT_EQ(backend.batches(), 3);
}

TEST(EngineBackends, AreThoseThatRunHereOrThoseNamed) {
  EngineOptions options;
  const std::vector<std::string> all = engine_backends(options);
  EXPECT_NE(std::find(all.begin(), all.end(), "scalar"), all.end());
  EXPECT_NE(std::find(all.begin(), all.end(), "simd"), all.end());
  EXPECT_LE(all.size() + missing_backends().size(), kBackends.size());
  for (const std::string& name : all) {
    EXPECT_EQ(make_backend(name)->name(), name) << "none twice";
  }
  options.backends = {"simd", "scalar", "simd"};
  EXPECT_EQ(engine_backends(options), (std::vector<std::string>{"simd", "scalar"}));
  options.backends = {"abacus"};
  EXPECT_THROW(engine_backends(options), Error);
}

TEST(ThroughputTables, HaveARowPerImageAndAColumnPerBatch) {
  std::vector<Throughput> cells;
  for (const std::size_t batch : {1, 10, 100, 1000, 10000, 100000}) {
    cells.push_back({"a", "160x120", 1, batch, BatchTime{2e-6 * static_cast<double>(batch), {}}});
  }
  for (const std::size_t batch : {1, 10, 100, 1000, 10000, 100000}) {
    cells.push_back({"b", "160x120", 1, batch, std::nullopt});
  }
  cells[7].time = BatchTime{5e-3, DeviceTimes{1e-3, 3e-3, 5e-4}};
  const Table times = time_table(cells);
  ASSERT_EQ(times.rows.size(), 2U);
  ASSERT_EQ(times.columns.size(), 9U);
  EXPECT_EQ(times.rows[0][3], "2");
  EXPECT_EQ(times.rows[0][8], "2");
  EXPECT_EQ(times.rows[1][3], "-");
  EXPECT_EQ(times.rows[1][4], "500");
  EXPECT_EQ(speed_table(cells).rows[0][5], "500");
  const Table device = device_table(cells);
  ASSERT_EQ(device.rows.size(), 1U);
  EXPECT_EQ(device.rows[0], (std::vector<std::string>{"b", "160x120", "10", "1", "3", "0.5"}));
}

TEST(EngineTables, AreWhole) {
  Clock clock;  // each look at it is a millisecond later
  EngineOptions options;
  options.quick = true;
  options.seconds = [&clock] { return clock.now += 1e-3; };
  for (const Table& table : {stage_table(options), instruction_set_table(options), opencv_table(options)}) {
    EXPECT_FALSE(table.rows.empty()) << table.title;
    for (const auto& row : table.rows) {
      EXPECT_EQ(row.size(), table.columns.size()) << table.title;
    }
  }
}

TEST(OverlapTimes, HaveThePublishedOnesBeside) {
  Clock clock;
  EngineOptions options;
  options.quick = true;
  options.backends = {"scalar"};
  options.seconds = [&clock] { return clock.now += 1e-2; };
  const Table table = overlap_time_table(options);
  ASSERT_EQ(table.rows.size(), 4U);
  EXPECT_EQ(table.columns.size(), 6U);
  EXPECT_EQ(table.rows[1], (std::vector<std::string>{"300", "10", "40.3", "19.8", "2.7", "2.5"}));
}

}  // namespace
}  // namespace telemime
