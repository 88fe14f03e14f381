// SPDX-License-Identifier: Apache-2.0
// Pictures that show nobody, or not enough: the poses stop, and words name the cause.
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "support/pictures.h"
#include "track/quick_run.h"

namespace telemime {
namespace {

Frame frame_of(const cv::Mat& image, std::size_t index) {
  return {image, static_cast<std::int64_t>(index), static_cast<double>(index) / support::kClipFps};
}

// A dim red glow with the noise of a camera.
cv::Mat hand_on_lens() {
  Random random(1);
  const cv::Size size = clip().person.front().image.size();
  cv::Mat out(size, CV_8UC3);
  for (int r = 0; r < size.height; ++r) {
    for (int c = 0; c < size.width; ++c) {
      const double glow = 25 + 0.1 * c;
      out.at<cv::Vec3b>(r, c) = {cv::saturate_cast<unsigned char>(0.3 * glow + random.normal(0, 3)),
                                 cv::saturate_cast<unsigned char>(0.5 * glow + random.normal(0, 3)),
                                 cv::saturate_cast<unsigned char>(2 * glow + random.normal(0, 3))};
    }
  }
  return out;
}

bool mentions(const FrameFeatures& features, const std::string& words) {
  return std::any_of(features.warnings.begin(), features.warnings.end(),
                     [&](const std::string& w) { return w.find(words) != std::string::npos; });
}

// After the person this picture a few times: it shows nobody, and words name the cause. Returns its records.
std::vector<FrameRecord> expect_nobody(const cv::Mat& picture, const std::string& words) {
  TrackingRun run = learned_run();
  for (const Frame& frame : clip().person) {
    track_frame(frame, run);
  }
  EXPECT_EQ(run.state.phase, Phase::tracking);
  std::vector<FrameRecord> records;
  for (std::size_t i = 0; i < 3; ++i) {
    records.push_back(track_frame(frame_of(picture, kPersonFrames + i), run));
    EXPECT_EQ(records.back().estimate.motion.state, TrackState::lost) << i;
    EXPECT_TRUE(mentions(records.back().features, words)) << i;
  }
  return records;
}

TEST(DifficultPictures, HandOnTheLensIsNobody) {
  for (const FrameRecord& record : expect_nobody(hand_on_lens(), "in front of the lens")) {
    EXPECT_FALSE(mentions(record.features, "no person")) << "only the cause";
  }
}

TEST(DifficultPictures, BlackPictureIsNobody) {
  expect_nobody(cv::Mat::zeros(clip().person.front().image.size(), CV_8UC3), "is the lens covered?");
}

TEST(DifficultPictures, EmptyRoomIsNobody) {
  expect_nobody(clip().background.front().image, "no person is visible");
}

TEST(DifficultPictures, GreyPictureSwitchesRegionsOff) {
  TrackingRun run = quick_run(quick_config());
  std::vector<Frame> empty;
  for (const Frame& frame : clip().background) {
    empty.push_back({support::grey(frame.image), frame.index, frame.time});
  }
  run.scene.features.learn_background(empty);
  for (std::size_t i = 0; i < clip().person.size(); ++i) {
    const FrameRecord record = track_frame(frame_of(support::grey(clip().person[i].image), i), run);
    EXPECT_FALSE(record.features.has_colour_model) << i;
    EXPECT_TRUE(mentions(record.features, "no colour")) << i;
    // Without networks nothing is left to follow.
    EXPECT_EQ(record.estimate.motion.state, TrackState::lost) << i;
    EXPECT_FALSE(record.estimate.note.empty()) << i;
  }
}

}  // namespace
}  // namespace telemime
