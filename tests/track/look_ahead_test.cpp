// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/look_ahead.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "support/list_source.h"
#include "track/quick_tracker.h"

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

// Somebody whose face is never found, and who is half hidden at first.
TEST(LookAhead, WhereNoFaceIsSeenALaterOutlineIsTakenToo) {
  std::vector<Frame> frames = clip().person;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Eigen::Vector2d head = clip().camera.project(clip().truth[i][Joint::head]);
    cv::Mat image = frames[i].image.clone();
    const cv::Rect face = cv::Rect(static_cast<int>(head.x()) - 26, static_cast<int>(head.y()) - 26, 52, 52) &
                          cv::Rect(0, 0, image.cols, image.rows);
    cv::Mat masked = image(face);
    cv::blur(masked, masked, {15, 15});
    if (i == 0) {
      // A board of the shirt's colour before the person.
      const Eigen::Vector2d neck = clip().camera.project(clip().truth[i][Joint::neck]);
      const auto shirt = image.at<cv::Vec3b>(static_cast<int>(neck.y()) + 30, static_cast<int>(neck.x()));
      cv::rectangle(image, cv::Rect(10, static_cast<int>(neck.y()) + 60, image.cols - 20, 50),
                    cv::Scalar(shirt[0], shirt[1], shirt[2]), cv::FILLED);
    }
    frames[i].image = image;
  }
  Config config = quick_config();
  config.calibration.worst_region = 1.0;
  Tracker tracker = make_tracker(config);
  tracker.learn_background(clip().background);
  support::ListSource source(frames);
  const auto found = look_ahead(source, config, clip().camera, tracker.features().calibration(), 0,
                                [](std::int64_t) { return true; });
  ASSERT_TRUE(found);
  EXPECT_GT(found->start.frame, 0);
  // It would have been the first frame, and there was no face.
  Tracker scout = make_tracker(config);
  scout.learn_background(clip().background);
  for (const Frame& frame : frames) {
    const TrackedFrame seen = scout.step(frame);
    EXPECT_EQ(seen.motion.state, TrackState::tracking) << frame.index;
    ASSERT_TRUE(seen.features.head) << frame.index;
    EXPECT_FALSE(seen.features.head->detected) << frame.index;
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
