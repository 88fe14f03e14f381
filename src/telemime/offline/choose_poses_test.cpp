// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/choose_poses.h"

#include <gtest/gtest.h>

#include "telemime/body/testing_poses.h"
#include "telemime/core/time_base.h"
#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

using testing_poses::farthest_joint;
using testing_scene::both_arms_seen;
using testing_scene::Scene;

Config quick() {
  Config config;
  config.look_back = true;
  config.backend = "scalar";
  config.threads = 1;
  config.filter.particles = 100;
  config.filter.mode_most = 100;
  config.filter.turn_evaluations = config.filter.walk_evaluations = 20;
  config.offline.stretch = 4;
  config.offline.overlap = 2;
  config.offline.evaluations = 60;
  config.offline.sweeps = 1;
  return config;
}

Pose with_a_wrong_arm() {
  Pose pose = both_arms_seen();
  pose[Angle::l_shoulder_abduct] += 0.4;
  return pose;
}

class ChoosePoses : public ::testing::Test {
 protected:
  FrameRecord record(std::int64_t index, bool tracked, const Pose& pose = both_arms_seen()) const {
    FrameRecord record;
    MotionFrame& motion = record.estimate.motion;
    motion.frame = index;
    motion.time = static_cast<double>(index) / kUnitsPerSecond;
    motion.pose = pose;
    motion.state = tracked ? TrackState::tracking : TrackState::lost;
    place_joints(scene.model.body, scene.camera, motion);
    if (tracked) {
      record.estimate.prepared = frame_of_model(scene.model, both_arms_seen(), scene.camera);
      record.estimate.modes = {pose};
      motion.spread = PoseSpread{};
      motion.spread->covariance.fill(Eigen::Matrix3d::Zero());
    }
    return record;
  }
  void push(FrameRecord next) {
    queue.records.push_back(std::move(next));
    ++queue.filled;
  }
  // Takes the records out that are decided by now.
  std::vector<FrameRecord> take(bool last = false) {
    choose_poses(run.tracker, scene.model, last, window, queue);
    std::vector<FrameRecord> records;
    for (; queue.chosen > 0; --queue.chosen, --queue.filled) {
      records.push_back(std::move(queue.records.front()));
      queue.records.pop_front();
    }
    return records;
  }
  std::vector<std::int64_t> indices(bool last = false) {
    std::vector<std::int64_t> indices;
    for (const FrameRecord& record : take(last)) {
      indices.push_back(record.estimate.motion.frame);
    }
    return indices;
  }

  Scene scene;
  TrackingRun run = make_tracking_run(quick(), scene.camera);
  WindowState window{run.tracker.config};
  RecordQueue queue;
};

TEST_F(ChoosePoses, DecidesOnceAWindowIsWhole) {
  for (std::int64_t i = 0; i < 5; ++i) {
    push(record(i, true));
    EXPECT_TRUE(take().empty()) << i;
  }
  push(record(5, true));
  EXPECT_EQ(indices(), (std::vector<std::int64_t>{0, 1, 2, 3}));
  EXPECT_EQ(indices(true), (std::vector<std::int64_t>{4, 5}));
  EXPECT_TRUE(take(true).empty());
}

TEST_F(ChoosePoses, WindowsLastForATime) {
  // Four units are kept and two more looked at, to half a unit, at 50 and at 12.5 frames per second.
  for (const auto& [unit, whole, kept] : {std::tuple(0.5, 11, 7), std::tuple(2.0, 4, 3)}) {
    window = WindowState(run.tracker.config);
    for (std::int64_t i = 0; i < whole; ++i) {
      FrameRecord next = record(i, true);
      next.estimate.motion.time = unit * static_cast<double>(i) / kUnitsPerSecond;
      push(std::move(next));
      EXPECT_EQ(take().size(), i + 1 < whole ? 0U : static_cast<std::size_t>(kept)) << unit << " " << i;
    }
    take(true);
  }
}

TEST_F(ChoosePoses, LostFramesDoNotWait) {
  push(record(0, false));
  EXPECT_EQ(indices(), (std::vector<std::int64_t>{0}));
  push(record(1, true));
  push(record(2, true));
  EXPECT_TRUE(take().empty());
  push(record(3, false));
  EXPECT_EQ(indices(), (std::vector<std::int64_t>{1, 2, 3}));
}

TEST_F(ChoosePoses, GoesOnAfterTheLastFrameOfAPerson) {
  push(record(0, true));
  EXPECT_EQ(take(true).size(), 1U);
  push(record(1, true));
  EXPECT_TRUE(take().empty()) << "another window has begun";
}

TEST_F(ChoosePoses, KeepsForwardPosesOnRequest) {
  for (std::int64_t i = 0; i < 2; ++i) {
    push(record(i, true, with_a_wrong_arm()));
  }
  EXPECT_TRUE(take().empty());
  keep_forward_poses(queue);
  const std::vector<FrameRecord> records = take();
  ASSERT_EQ(records.size(), 2U);
  for (std::int64_t i = 0; i < 2; ++i) {
    const MotionFrame& motion = records[static_cast<std::size_t>(i)].estimate.motion;
    EXPECT_EQ(motion.frame, i);
    EXPECT_EQ(motion.pose.vector(), with_a_wrong_arm().vector());
    EXPECT_EQ(motion.evaluations, 0);
  }
}

TEST_F(ChoosePoses, PoseJointsAndScoresBelongTogether) {
  for (std::int64_t i = 0; i < 3; ++i) {
    push(record(i, true, i == 1 ? with_a_wrong_arm() : both_arms_seen()));
  }
  const std::vector<FrameRecord> records = take(true);
  ASSERT_EQ(records.size(), 3U);
  const MotionFrame& motion = records[1].estimate.motion;
  MotionFrame own = motion;
  place_joints(scene.model.body, scene.camera, own);
  EXPECT_EQ(farthest_joint(own.joints, motion.joints), 0.0);
  EXPECT_LT(farthest_joint(motion.joints, scene.joints(both_arms_seen())), 0.06) << "was 0.2 m away";
  EXPECT_LT(motion.region_score, 0.1);
  ASSERT_TRUE(motion.spread);
  const auto wrist = static_cast<std::size_t>(Joint::l_wrist);
  EXPECT_GT(motion.spread->covariance[wrist].trace(), 0.01) << "the filter and the trajectory disagree";
}

TEST_F(ChoosePoses, APauseParts) {
  const auto timed = [&](std::int64_t index, double time) {
    FrameRecord made = record(index, true, index < 2 ? both_arms_seen() : with_a_wrong_arm());
    made.estimate.motion.time = time;
    return made;
  };
  // Together, with a pause between them, and one after the other.
  const auto poses = [](const std::vector<FrameRecord>& records) {
    std::vector<PoseVector> all;
    for (const FrameRecord& r : records) {
      all.push_back(r.estimate.motion.pose.vector());
    }
    return all;
  };
  const std::vector<double> times = {0.0, 0.04, 15.0, 15.04};
  for (std::size_t i = 0; i < times.size(); ++i) {
    push(timed(static_cast<std::int64_t>(i), times[i]));
  }
  const std::vector<PoseVector> together = poses(take(true));
  window = WindowState(run.tracker.config);
  std::vector<PoseVector> apart;
  for (std::size_t i = 0; i < times.size(); ++i) {
    push(timed(static_cast<std::int64_t>(i), times[i]));
    const std::vector<PoseVector> some = poses(take(i % 2 == 1));
    apart.insert(apart.end(), some.begin(), some.end());
  }
  EXPECT_EQ(together, apart);
}

TEST_F(ChoosePoses, SameSeedGivesSamePoses) {
  std::vector<PoseVector> first;
  for (int repeat = 0; repeat < 2; ++repeat) {
    window = WindowState(run.tracker.config);
    for (std::int64_t i = 0; i < 8; ++i) {
      push(record(i, true));
    }
    const std::vector<FrameRecord> records = take(true);
    ASSERT_EQ(records.size(), 8U);
    for (std::size_t t = 0; t < records.size(); ++t) {
      const PoseVector pose = records[t].estimate.motion.pose.vector();
      if (repeat == 0) {
        first.push_back(pose);
      } else {
        EXPECT_EQ(pose, first[t]) << t;
      }
    }
  }
}

}  // namespace
}  // namespace telemime
