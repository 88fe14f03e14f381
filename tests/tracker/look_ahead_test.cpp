// SPDX-License-Identifier: Apache-2.0
#include "telemime/pipeline/look_ahead.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "support/list_source.h"
#include "tracker/quick_tracker.h"

namespace telemime {
namespace {

TEST(LookAhead, FitsTheShapeAndSaysWhereToStart) {
  Config config = quick_config();
  config.calibration.refine.rounds = 1;
  config.calibration.refine.pose_iterations = 20;
  config.calibration.refine.shapes = 10;
  Tracker tracker = make_tracker(config);
  tracker.learn_background(clip().background);
  support::ListSource source(clip().person);
  std::int64_t asked = 0;
  const auto found = look_ahead(source, config, clip().camera, tracker.features().calibration(), 0,
                                [&](std::int64_t) { return ++asked > 0; });
  ASSERT_TRUE(found);
  EXPECT_EQ(asked, kPersonFrames);
  EXPECT_EQ(found->frames, kPersonFrames);
  EXPECT_EQ(found->start.frame, 0);
  EXPECT_LE(found->cost, found->cost_before);
  tracker.start_with(found->start);
  for (const Frame& frame : clip().person) {
    EXPECT_EQ(tracker.step(frame).motion.state, TrackState::tracking) << frame.index;
  }
}

// Head and shoulders, the arms below the picture.
TEST(LookAhead, APortraitKeepsAverageArms) {
  double lowest = 0.0;
  for (const JointPositions& joints : clip().truth) {
    for (const Joint shoulder : {Joint::l_shoulder, Joint::r_shoulder}) {
      lowest = std::max(lowest, clip().camera.project(joints[shoulder]).y());
    }
  }
  const int rows = 4 * static_cast<int>((lowest + 12.0) / 4.0);
  ASSERT_LT(rows, 200);
  const auto portrait = [&](std::vector<Frame> frames) {
    for (Frame& frame : frames) {
      frame.image = frame.image.rowRange(0, rows).clone();
    }
    return frames;
  };
  Camera camera = clip().camera;
  camera.height = rows;
  Config config = quick_config();
  config.image.height = rows / 2;
  Tracker tracker(config, camera);
  tracker.learn_background(portrait(clip().background));
  support::ListSource source(portrait(clip().person));
  const auto found = look_ahead(source, config, camera, tracker.features().calibration(), 0,
                                [](std::int64_t) { return true; });
  ASSERT_TRUE(found);
  EXPECT_EQ(found->keyframes, 0U);
  EXPECT_FALSE(found->start.person.refusal.empty());
  for (const Segment arm :
       {Segment::l_upper_arm, Segment::r_upper_arm, Segment::l_forearm, Segment::r_forearm}) {
    EXPECT_NEAR(found->start.person.shape[arm].length, Shape()[arm].length, 0.01);
  }
  tracker.start_with(found->start);
  for (const Frame& frame : portrait(clip().person)) {
    EXPECT_EQ(tracker.step(frame).motion.state, TrackState::tracking) << frame.index;
  }
}

TEST(LookAhead, NobodyOrAStopIsNoStart) {
  const Config config = quick_config();
  Tracker tracker = make_tracker(config);
  tracker.learn_background(clip().background);
  const ImageCalibration& scene = tracker.features().calibration();
  support::ListSource empty({clip().background.begin(), clip().background.begin() + 3});
  EXPECT_FALSE(look_ahead(empty, config, clip().camera, scene, 0, [](std::int64_t) { return true; }));
  support::ListSource person(clip().person);
  EXPECT_FALSE(look_ahead(person, config, clip().camera, scene, 0, [](std::int64_t) { return false; }));
}

}  // namespace
}  // namespace telemime
