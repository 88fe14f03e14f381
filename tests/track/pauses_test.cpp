// SPDX-License-Identifier: Apache-2.0
// Pauses of the input, and windows that are times at any frame rate.
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "telemime/core/time_base.h"
#include "track/quick_run.h"

namespace telemime {
namespace {

// The person moved while no frame came.
TEST(Tracker, SearchesAnewAfterAPause) {
  constexpr int kAside = 40;  // px
  std::vector<Frame> frames(clip().person.begin(), clip().person.begin() + 4);
  const cv::Mat& empty = clip().background.front().image;
  const auto shift = [&](const cv::Mat& image) {
    cv::Mat person;
    cv::absdiff(image, empty, person);
    cv::cvtColor(person, person, cv::COLOR_BGR2GRAY);
    const cv::Rect from(0, 0, image.cols - kAside, image.rows);
    cv::Mat moved = empty.clone();
    image(from).copyTo(moved(from + cv::Point(kAside, 0)), person(from) > 12);
    return moved;
  };
  frames[3].image = shift(frames[2].image);
  for (const double pause : {0.04, 1.0, 1.5, 15.0}) {
    frames[3].time = frames[2].time + pause;
    TrackingRun run = learned_run();
    for (std::size_t i = 0; i < 3; ++i) {
      track_frame(frames[i], run);
    }
    ASSERT_TRUE(run.state.filter.started());
    const double before = run.state.pose.root.x();
    const FrameEstimate found = track_frame(frames[3], run).estimate;
    // The search starts from the head in the image, and no hypothesis is left.
    EXPECT_EQ(run.state.filter.started(), pause <= 1.0) << pause;
    if (pause > 1.0) {
      EXPECT_EQ(found.motion.state, TrackState::tracking) << found.note;
      EXPECT_LT(found.motion.region_score, 0.5) << pause;
      EXPECT_NEAR(found.motion.pose.root.x() - before, kAside * run.state.pose.root.z() / clip().camera.fx,
                  0.08);
    }
  }
  // Nobody is there any more.
  frames[3].image = empty;
  TrackingRun run = learned_run();
  for (const Frame& frame : frames) {
    const FrameEstimate seen = track_frame(frame, run).estimate;
    EXPECT_EQ(seen.motion.state, frame.time > 10.0 ? TrackState::lost : TrackState::tracking);
    EXPECT_EQ(seen.note.empty(), frame.time < 10.0);
  }
}

TEST(Tracker, PatienceIsATime) {
  Config config = quick_config();
  config.tracking.lost_region = 1e-6;  // every frame is bad
  config.tracking.patience = 2;        // 1/25 s
  for (const double fps : {25.0, 125.0, 250.0}) {
    std::vector<Frame> frames;
    for (std::int64_t i = 0; i < 26; ++i) {
      frames.push_back(clip().person[static_cast<std::size_t>(i % kPersonFrames)]);
      frames.back().index = i;
      frames.back().time = static_cast<double>(i) / fps;
    }
    const auto motion = track(config, frames);
    const auto lost = std::find_if(motion.begin(), motion.end(),
                                   [](const MotionFrame& m) { return m.state == TrackState::lost; });
    EXPECT_NEAR(static_cast<double>(lost - motion.begin()) / fps, 2.0 / 25.0, 1.01 / fps) << fps;
  }
}

TEST(TimeStep, OfSettingsHasNoBounds) {
  EXPECT_EQ(units_between(0.0, 0.0405), 1.0);
  EXPECT_EQ(units_between(7.0, 7.0), 1.0);
  EXPECT_NEAR(units_between(0.0, 1.0 / 240.0), 25.0 / 240.0, 1e-9);
  EXPECT_NEAR(units_between(0.0, 100.0), 2500.0, 1e-9);
}

TEST(TimeStep, IsOneIfUsualOrUnknown) {
  EXPECT_EQ(steps_between(0.0, 0.04), 1.0);
  EXPECT_EQ(steps_between(1.0, 1.0415), 1.0);  // the clock of a camera
  EXPECT_EQ(steps_between(7.0, 7.0), 1.0);
  EXPECT_EQ(steps_between(7.0, 3.0), 1.0);
  EXPECT_NEAR(steps_between(1.0, 1.2), 5.0, 1e-9);
  EXPECT_NEAR(steps_between(1.0, 1.0 + 1.0 / 30.0), 25.0 / 30.0, 1e-9);
  EXPECT_EQ(steps_between(0.0, 100.0), 8.0);
  EXPECT_EQ(steps_between(0.0, 0.001), 0.2);
}

}  // namespace
}  // namespace telemime
