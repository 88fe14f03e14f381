// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/offline.h"

#include <gtest/gtest.h>

#include "telemime/tracker/tracker.h"
#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

using testing_scene::both_arms_seen;
using testing_scene::farthest_joint;
using testing_scene::Scene;

Config quick() {
  Config config;
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

OfflineFrame seen(Scene& scene, std::int64_t index, bool tracked) {
  OfflineFrame frame;
  frame.motion.frame = index;
  frame.motion.pose = both_arms_seen();
  frame.motion.state = tracked ? TrackState::tracking : TrackState::lost;
  complete(frame.motion, scene.model.body, scene.camera);
  if (tracked) {
    frame.stretch =
        StretchFrame{frame_of_model(scene.model, both_arms_seen(), scene.camera), 0.0, {both_arms_seen()}, 1};
    frame.motion.spread = PoseSpread{};
    frame.motion.spread->covariance.fill(Eigen::Matrix3d::Zero());
  }
  return frame;
}

// Indices of the frames that come out by now.
std::vector<std::int64_t> take(OfflineTracker& offline, const Scene& scene) {
  std::vector<std::int64_t> indices;
  while (const auto frame = offline.next(scene.model, scene.camera)) {
    indices.push_back(frame->motion.frame);
  }
  return indices;
}

TEST(OfflineTracker, FramesComeInTheirOrderOnceAStretchIsWhole) {
  Scene scene;
  OfflineTracker offline(quick(), scene.limits);
  for (std::int64_t i = 0; i < 5; ++i) {
    offline.push(seen(scene, i, true));
    EXPECT_TRUE(take(offline, scene).empty()) << i;
  }
  offline.push(seen(scene, 5, true));
  EXPECT_EQ(take(offline, scene), (std::vector<std::int64_t>{0, 1, 2, 3}));
  offline.finish();
  EXPECT_EQ(take(offline, scene), (std::vector<std::int64_t>{4, 5}));
  EXPECT_TRUE(take(offline, scene).empty());
}

TEST(OfflineTracker, WhereNobodyIsTrackedNothingWaitsOrChanges) {
  Scene scene;
  OfflineTracker offline(quick(), scene.limits);
  offline.push(seen(scene, 0, false));
  EXPECT_EQ(take(offline, scene), (std::vector<std::int64_t>{0}));
  offline.push(seen(scene, 1, true));
  offline.push(seen(scene, 2, true));
  EXPECT_TRUE(take(offline, scene).empty());
  offline.push(seen(scene, 3, false));
  EXPECT_EQ(take(offline, scene), (std::vector<std::int64_t>{1, 2, 3}));
}

TEST(OfflineTracker, GoesOnAfterItWasFinished) {
  Scene scene;
  OfflineTracker offline(quick(), scene.limits);
  offline.push(seen(scene, 0, true));
  offline.finish();
  EXPECT_EQ(take(offline, scene).size(), 1U);
  offline.push(seen(scene, 1, true));
  EXPECT_TRUE(take(offline, scene).empty()) << "another stretch has begun";
}

TEST(OfflineTracker, GivesWhatWaitsAsItIsWhenItGivesUp) {
  Scene scene;
  OfflineTracker offline(quick(), scene.limits);
  for (std::int64_t i = 0; i < 2; ++i) {
    OfflineFrame frame = seen(scene, i, true);
    frame.motion.pose = with_a_wrong_arm();
    offline.push(std::move(frame));
  }
  EXPECT_TRUE(take(offline, scene).empty());
  offline.give_up();
  for (std::int64_t i = 0; i < 2; ++i) {
    const auto frame = offline.next(scene.model, scene.camera);
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->motion.frame, i);
    EXPECT_EQ(frame->motion.pose.vector(), with_a_wrong_arm().vector());
    EXPECT_EQ(frame->motion.evaluations, 0);
  }
  EXPECT_FALSE(offline.next(scene.model, scene.camera));
}

TEST(OfflineTracker, PoseJointsPixelsAndScoresBelongTogether) {
  Scene scene;
  OfflineTracker offline(quick(), scene.limits);
  for (std::int64_t i = 0; i < 3; ++i) {
    OfflineFrame frame = seen(scene, i, true);
    if (i == 1) {
      frame.motion.pose = with_a_wrong_arm();
      frame.stretch->candidates = {with_a_wrong_arm()};
      complete(frame.motion, scene.model.body, scene.camera);
    }
    offline.push(std::move(frame));
  }
  offline.finish();
  offline.next(scene.model, scene.camera);
  const auto middle = offline.next(scene.model, scene.camera);
  ASSERT_TRUE(middle);
  const MotionFrame& motion = middle->motion;
  MotionFrame own = motion;
  complete(own, scene.model.body, scene.camera);
  EXPECT_EQ(farthest_joint(own.joints, motion.joints), 0.0);
  EXPECT_LT(farthest_joint(motion.joints, scene.joints(both_arms_seen())), 0.06) << "was 0.2 m away";
  EXPECT_LT(motion.region_score, 0.1);
  ASSERT_TRUE(motion.spread);
  const auto wrist = static_cast<std::size_t>(Joint::l_wrist);
  EXPECT_GT(motion.spread->covariance[wrist].trace(), 0.01) << "the filter and the trajectory disagree";
}

TEST(OfflineTracker, SameSeedSamePoses) {
  Scene scene;
  std::vector<PoseVector> first;
  for (int repeat = 0; repeat < 2; ++repeat) {
    OfflineTracker offline(quick(), scene.limits);
    for (std::int64_t i = 0; i < 8; ++i) {
      offline.push(seen(scene, i, true));
    }
    offline.finish();
    std::size_t t = 0;
    while (const auto frame = offline.next(scene.model, scene.camera)) {
      if (repeat == 0) {
        first.push_back(frame->motion.pose.vector());
      } else {
        EXPECT_EQ(frame->motion.pose.vector(), first[t]) << t;
      }
      ++t;
    }
    EXPECT_EQ(t, 8U);
  }
}

}  // namespace
}  // namespace telemime
