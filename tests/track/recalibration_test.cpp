// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <utility>
#include <vector>

#include "track/quick_run.h"

namespace telemime {
namespace {

TEST(Recalibration, RestartsWithThePerson) {
  TrackingRun run = learned_run();
  track_frame(clip().person[0], run);
  ASSERT_TRUE(run.state.person);
  forget_person(run);
  EXPECT_FALSE(run.state.person);
  for (int i = 1; i < kPersonFrames; ++i) {  // it waits for a frame with a face detection
    track_frame(clip().person[static_cast<std::size_t>(i)], run);
  }
  EXPECT_TRUE(run.state.person);
}

TEST(Recalibration, KeepsNoOldParticle) {
  Config config = quick_config();
  config.look_back = true;  // the candidates are the modes of the filter
  TrackingRun run = learned_run(config);
  std::size_t most = 0;
  for (const Frame& frame : clip().person) {
    const FrameRecord seen = track_frame(frame, run);
    most = std::max(most, seen.estimate.modes.size());
  }
  ASSERT_GT(most, 1U) << "the filter is running";
  forget_person(run);
  for (const Frame& frame : clip().person) {
    const FrameRecord seen = track_frame(frame, run);
    if (!seen.estimate.modes.empty()) {
      ASSERT_EQ(seen.estimate.modes.size(), 1U);
      EXPECT_EQ(seen.estimate.modes.front().vector(), seen.estimate.motion.pose.vector());
      return;
    }
  }
  FAIL() << "no person was calibrated again";
}

// The blue shirt of the person becomes red.
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

TEST(Recalibration, LearnsColoursOfTheNewPerson) {
  const std::vector<Frame> frames = in_other_clothes();
  const auto clothes = [](const TrackingRun& run) {
    return run.scene.features.calibration().colours.clothes.front().mean;
  };
  TrackingRun expected = learned_run();
  track_frame(frames.front(), expected);
  ASSERT_TRUE(expected.state.person);

  TrackingRun run = learned_run();
  track_frame(clip().person.front(), run);
  ASSERT_GT((clothes(run) - clothes(expected)).norm(), 0.3F) << "they differ";
  forget_person(run);
  track_frame(clip().background.front(), run);
  EXPECT_FALSE(run.state.person) << "no person is visible";
  for (std::size_t i = 0; i < frames.size() && !run.state.person; ++i) {
    track_frame(frames[i], run);
  }
  ASSERT_TRUE(run.state.person);
  EXPECT_LT((clothes(run) - clothes(expected)).norm(), 0.1F);
}

TEST(Recalibration, ColoursOfTheLastPersonAreNotUsedOnceThePersonIsCalibrated) {
  // A network may calibrate the next person before their colours are learned.
  TrackingRun run = learned_run();
  track_frame(clip().person[0], run);
  ASSERT_TRUE(run.scene.features.calibration().colours.known());
  forget_person(run);
  Frame frame = clip().person[1];
  frame.index = 1;  // colours are learned in every fifth
  EXPECT_FALSE(extract(frame, ColourRequest::keep, run.scene).has_colour_model);
  frame.index = 5;
  EXPECT_TRUE(extract(frame, ColourRequest::keep, run.scene).has_colour_model);
}

}  // namespace
}  // namespace telemime
