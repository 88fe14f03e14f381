// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/engine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "telemime/core/errors.h"
#include "telemime/search/budget.h"

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
  void count(const PreparedFrame&, const Model&, std::span<const Pose> poses, std::span<const Kinematics>,
             Reduction, std::span<Reductions> counts) override {
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
  for (const Table& table : {scalar_stage_table(options), simd_stage_table(options),
                             instruction_set_table(options), opencv_table(options)}) {
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

TEST(Opencv, BothComeNearToTheDefinition) {
  for (const auto make : {make_fast_opencv, make_literal_opencv}) {
    const auto opencv = make();
    const auto scalar = make_scalar_backend();
    const Model model = make_model(Shape{});
    for (const Camera& camera : engine_cameras()) {
      Random random(5);
      std::vector<Pose> poses = typical_poses(30, random);
      const PreparedFrame frame = frame_of_model(model, poses.front(), camera);
      std::vector<Score> near(poses.size());
      std::vector<Score> exact(poses.size());
      opencv->evaluate(frame, model, poses, Reduction::all, near);
      scalar->evaluate(frame, model, poses, Reduction::all, exact);
      double mean = 0.0;
      for (std::size_t i = 0; i < poses.size(); ++i) {
        const double difference = std::abs(near[i].region() - exact[i].region());
        mean += difference / static_cast<double>(poses.size());
        // Largest at the true pose, where every differently drawn pixel is an error.
        EXPECT_LT(difference, 0.13) << camera.width << ", pose " << i;
        EXPECT_GT(near[i].reductions.contour_points, exact[i].reductions.contour_points / 3);
        EXPECT_EQ(near[i].reductions.observed, exact[i].reductions.observed);
      }
      EXPECT_LT(mean, 0.05) << camera.width;
      EXPECT_LT(near.front().contour(), near[1].contour()) << "the true pose has the smallest distance";
    }
  }
}

TEST(Opencv, BodyOutOfThePictureOverlapsNothing) {
  const Model model = make_model(Shape{});
  Random random(5);
  Pose pose = typical_poses(1, random).front();
  const PreparedFrame frame = frame_of_model(model, pose, engine_cameras().front());
  std::vector<Pose> gone = {pose, pose};
  gone[0].root.x() = 20.0;
  gone[1].root.z() = -3.0;
  std::vector<Score> scores(2);
  make_fast_opencv()->evaluate(frame, model, gone, Reduction::all, scores);
  for (const Score& score : scores) {
    EXPECT_EQ(score.region(), 1.0);
    EXPECT_EQ(score.contour(), frame.distance_cap);
  }
  EXPECT_THROW(make_fast_opencv()->evaluate(frame, model, gone, Reduction::all, {}), Error);
}

TEST(Opencv, IgnoredPixelsCountNowhere) {
  const Model model = make_model(Shape{});
  Random random(5);
  const Pose pose = typical_poses(1, random).front();
  PreparedFrame frame = frame_of_model(model, pose, engine_cameras().front());
  frame.labels.setTo(255);
  frame.observed = {};
  Score score;
  make_fast_opencv()->evaluate(frame, model, {&pose, 1}, Reduction::overlap, {&score, 1});
  EXPECT_EQ(score.region(), 0.0);
}

}  // namespace
}  // namespace telemime
