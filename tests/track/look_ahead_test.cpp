// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/look_ahead.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "support/list_source.h"
#include "track/quick_run.h"

namespace telemime {
namespace {

TEST(LookAhead, FitsTheShapeAndChoosesTheStart) {
  Config config = quick_config();
  config.calibration.refine.rounds = 1;
  config.calibration.refine.pose_iterations = 20;
  config.calibration.refine.shapes = 10;
  TrackingRun run = learned_run(config);
  support::ListSource source(clip().person);
  std::int64_t asked = 0;
  const LookAhead ahead = look_ahead(
      {.next = [&] { return source.next(); }, .go_on = [&](const FrameRecord&) { return ++asked > 0; }}, run);
  ASSERT_TRUE(ahead.person);
  EXPECT_EQ(asked, kPersonFrames);
  EXPECT_EQ(ahead.person->frames, kPersonFrames);
  EXPECT_EQ(ahead.person->start.frame, 0);
  EXPECT_LE(ahead.person->cost, ahead.person->cost_before);
  ASSERT_EQ(ahead.records.size(), static_cast<std::size_t>(kPersonFrames));
  for (const FrameRecord& record : ahead.records) {
    EXPECT_EQ(record.estimate.motion.state, TrackState::tracking) << record.frame.index;
  }
}

TEST(LookAhead, LastsForATimeNotForFrames) {
  for (const auto& [fps, frames] : {std::pair(25.0, 4), std::pair(50.0, 6), std::pair(10.0, 3)}) {
    Config config = quick_config();
    config.calibration.look_ahead = 4;  // 1/25 s
    config.calibration.refine.rounds = 0;
    TrackingRun run = learned_run(config);
    std::vector<Frame> timed = clip().person;
    for (Frame& frame : timed) {
      frame.time = static_cast<double>(frame.index) / fps;
    }
    support::ListSource source(timed);
    const LookAhead ahead = look_ahead({.next = [&] { return source.next(); }}, run);
    EXPECT_EQ(ahead.records.size(), static_cast<std::size_t>(frames)) << fps;
  }
}

// A person whose face is never found and who is half hidden at first.
TEST(LookAhead, UsesLaterOutlineWithoutAFace) {
  std::vector<Frame> frames = clip().person;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Eigen::Vector2d head = clip().camera.project(clip().truth[i][Joint::head]);
    cv::Mat image = frames[i].image.clone();
    const cv::Rect face = cv::Rect(static_cast<int>(head.x()) - 26, static_cast<int>(head.y()) - 26, 52, 52) &
                          cv::Rect(0, 0, image.cols, image.rows);
    cv::Mat masked = image(face);
    cv::blur(masked, masked, {15, 15});
    if (i == 0) {
      // A board of the colour of the shirt in front of the person.
      const Eigen::Vector2d neck = clip().camera.project(clip().truth[i][Joint::neck]);
      const auto shirt = image.at<cv::Vec3b>(static_cast<int>(neck.y()) + 30, static_cast<int>(neck.x()));
      cv::rectangle(image, cv::Rect(10, static_cast<int>(neck.y()) + 60, image.cols - 20, 50),
                    cv::Scalar(shirt[0], shirt[1], shirt[2]), cv::FILLED);
    }
    frames[i].image = image;
  }
  Config config = quick_config();
  config.calibration.worst_region = 1.0;
  TrackingRun run = learned_run(config);
  support::ListSource source(frames);
  const LookAhead ahead = look_ahead({.next = [&] { return source.next(); }}, run);
  ASSERT_TRUE(ahead.person);
  EXPECT_GT(ahead.person->start.frame, 0);
  // It would be the first frame, but it has no face.
  TrackingRun scout = learned_run(config);
  for (const Frame& frame : frames) {
    const FrameRecord seen = track_frame(frame, scout);
    EXPECT_EQ(seen.estimate.motion.state, TrackState::tracking) << frame.index;
    ASSERT_TRUE(seen.features.head) << frame.index;
    EXPECT_FALSE(seen.features.head->detected) << frame.index;
  }
}

// Head and shoulders; the arms are below the image.
TEST(LookAhead, PortraitKeepsAverageArms) {
  double lowest = 0.0;
  for (const JointPositions& joints : clip().truth) {
    for (const Joint shoulder : {Joint::l_shoulder, Joint::r_shoulder}) {
      lowest = std::max(lowest, clip().camera.project(joints[shoulder]).y());
    }
  }
  const int rows = 4 * static_cast<int>((lowest + 12.0) / 4.0);
  ASSERT_LT(rows, 200);
  Camera camera = clip().camera;
  const int columns = rows * camera.width / camera.height;
  const int left = (camera.width - columns) / 2;
  const auto portrait = [&](std::vector<Frame> frames) {
    for (Frame& frame : frames) {
      frame.image = frame.image(cv::Rect(left, 0, columns, rows)).clone();
    }
    return frames;
  };
  camera.width = columns;
  camera.height = rows;
  camera.cx -= left;
  Config config = quick_config();
  TrackingRun run = make_tracking_run(config, camera);
  run.scene.features.learn_background(portrait(clip().background));
  support::ListSource source(portrait(clip().person));
  const LookAhead ahead = look_ahead({.next = [&] { return source.next(); }}, run);
  const auto& found = ahead.person;
  ASSERT_TRUE(found);
  EXPECT_EQ(found->keyframes, 0U);
  EXPECT_FALSE(found->start.person.refusal.empty());
  // They follow the shoulders a little, which are 8 % wider than average.
  for (const Segment arm :
       {Segment::l_upper_arm, Segment::r_upper_arm, Segment::l_forearm, Segment::r_forearm}) {
    EXPECT_NEAR(found->start.person.shape[arm].length, Shape()[arm].length, 0.0125);
  }
  for (const FrameRecord& record : ahead.records) {
    EXPECT_EQ(record.estimate.motion.state, TrackState::tracking) << record.frame.index;
  }
}

TEST(LookAhead, FindsNoPersonInAnEmptyScene) {
  TrackingRun run = learned_run();
  support::ListSource empty({clip().background.begin(), clip().background.begin() + 3});
  std::size_t settled = 0;
  const LookAhead ahead =
      look_ahead({.next = [&] { return empty.next(); }, .settle = [&](FrameRecord) { ++settled; }}, run);
  EXPECT_FALSE(ahead.person);
  EXPECT_EQ(settled + ahead.records.size(), 3U) << "no frame is dropped";
}

TEST(LookAhead, StopsOnRequest) {
  TrackingRun run = learned_run();
  support::ListSource person(clip().person);
  const LookAhead ahead = look_ahead(
      {.next = [&] { return person.next(); }, .go_on = [](const FrameRecord&) { return false; }}, run);
  EXPECT_FALSE(ahead.person);
  EXPECT_EQ(ahead.records.size(), 1U);
}

}  // namespace
}  // namespace telemime
