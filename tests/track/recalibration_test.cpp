// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "track/quick_tracker.h"

namespace telemime {
namespace {

TEST(Recalibration, BeginsAnewWithThePerson) {
  Tracker tracker = make_tracker(quick_config());
  tracker.learn_background(clip().background);
  tracker.step(clip().person[0]);
  ASSERT_TRUE(tracker.calibration());
  tracker.recalibrate();
  EXPECT_FALSE(tracker.calibration());
  for (int i = 1; i < kPersonFrames; ++i) {  // it waits for a frame in which the face is looked for
    tracker.step(clip().person[static_cast<std::size_t>(i)]);
  }
  EXPECT_TRUE(tracker.calibration());
}

TEST(Recalibration, LeavesNoOldParticle) {
  Config config = quick_config();
  config.look_back = true;  // its candidates show what the filter holds
  Tracker tracker = make_tracker(config);
  tracker.learn_background(clip().background);
  std::size_t most = 0;
  for (const Frame& frame : clip().person) {
    const TrackedFrame seen = tracker.step(frame);
    most = seen.stretch ? std::max(most, seen.stretch->candidates.size()) : most;
  }
  ASSERT_GT(most, 1U) << "the filter is at work";
  tracker.recalibrate();
  for (const Frame& frame : clip().person) {
    const TrackedFrame seen = tracker.step(frame);
    if (seen.stretch) {
      ASSERT_EQ(seen.stretch->candidates.size(), 1U);
      EXPECT_EQ(seen.stretch->candidates.front().vector(), seen.motion.pose.vector());
      return;
    }
  }
  FAIL() << "nobody was calibrated again";
}

// The person's blue shirt is red.
std::vector<Frame> in_other_clothes() {
  std::vector<Frame> frames = clip().person;
  const cv::Mat room = clip().background.front().image;
  for (Frame& frame : frames) {
    frame.image = frame.image.clone();
    frame.image.forEach<cv::Vec3b>([&](cv::Vec3b& pixel, const int* at) {
      const auto& behind = room.at<cv::Vec3b>(at[0], at[1]);
      if (pixel[0] > pixel[2] + 10 && cv::norm(pixel, behind, cv::NORM_INF) > 12) {
        std::swap(pixel[0], pixel[2]);
      }
    });
  }
  return frames;
}

TEST(Recalibration, LearnsTheColoursOfWhoeverIsThere) {
  const std::vector<Frame> frames = in_other_clothes();
  const auto clothes = [](const Tracker& tracker) {
    return tracker.features().calibration().colours.clothes.front().mean;
  };
  Tracker expected = make_tracker(quick_config());
  expected.learn_background(clip().background);
  expected.step(frames.front());
  ASSERT_TRUE(expected.calibration());

  Tracker tracker = make_tracker(quick_config());
  tracker.learn_background(clip().background);
  tracker.step(clip().person.front());
  ASSERT_GT((clothes(tracker) - clothes(expected)).norm(), 0.3F) << "they differ";
  tracker.recalibrate();
  tracker.step(clip().background.front());
  EXPECT_FALSE(tracker.calibration()) << "nobody is there";
  for (std::size_t i = 0; i < frames.size() && !tracker.calibration(); ++i) {
    tracker.step(frames[i]);
  }
  ASSERT_TRUE(tracker.calibration());
  EXPECT_LT((clothes(tracker) - clothes(expected)).norm(), 0.1F);
}

}  // namespace
}  // namespace telemime
