// SPDX-License-Identifier: Apache-2.0
// Pictures that show nobody, or not enough: the poses stop, and words name the cause.
#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

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

// The person, and then this picture a few times.
std::vector<FrameRecord> person_and_then(const cv::Mat& picture) {
  TrackingRun run = learned_run();
  std::vector<FrameRecord> records;
  for (const Frame& frame : clip().person) {
    records.push_back(track_frame(frame, run));
  }
  EXPECT_EQ(records.back().estimate.motion.state, TrackState::tracking);
  for (int i = 0; i < 3; ++i) {
    records.push_back(track_frame(frame_of(picture, records.size()), run));
  }
  return records;
}

TEST(DifficultPictures, HandOnTheLensIsNobody) {
  const auto records = person_and_then(hand_on_lens());
  for (std::size_t i = kPersonFrames; i < records.size(); ++i) {
    EXPECT_EQ(records[i].estimate.motion.state, TrackState::lost) << i;
    EXPECT_TRUE(mentions(records[i].features, "in front of the lens")) << i;
    EXPECT_FALSE(mentions(records[i].features, "no person")) << "only the cause";
  }
}

TEST(DifficultPictures, BlackPictureIsNobody) {
  const auto records = person_and_then(cv::Mat::zeros(clip().person.front().image.size(), CV_8UC3));
  for (std::size_t i = kPersonFrames; i < records.size(); ++i) {
    EXPECT_EQ(records[i].estimate.motion.state, TrackState::lost) << i;
    EXPECT_TRUE(mentions(records[i].features, "is the lens covered?")) << i;
  }
}

TEST(DifficultPictures, EmptyRoomIsNobody) {
  const auto records = person_and_then(clip().background.front().image);
  for (std::size_t i = kPersonFrames; i < records.size(); ++i) {
    EXPECT_EQ(records[i].estimate.motion.state, TrackState::lost) << i;
    EXPECT_TRUE(mentions(records[i].features, "no person is visible")) << i;
  }
}

TEST(DifficultPictures, GreyPictureSwitchesRegionsOff) {
  const auto grey = [](const cv::Mat& image) {
    cv::Mat one;
    cv::cvtColor(image, one, cv::COLOR_BGR2GRAY);
    cv::Mat three;
    cv::cvtColor(one, three, cv::COLOR_GRAY2BGR);
    return three;
  };
  TrackingRun run = quick_run(quick_config());
  std::vector<Frame> empty;
  for (const Frame& frame : clip().background) {
    empty.push_back({grey(frame.image), frame.index, frame.time});
  }
  run.scene.features.learn_background(empty);
  for (std::size_t i = 0; i < clip().person.size(); ++i) {
    const FrameRecord record = track_frame(frame_of(grey(clip().person[i].image), i), run);
    EXPECT_FALSE(record.features.has_colour_model) << i;
    EXPECT_TRUE(mentions(record.features, "no colour")) << i;
    // Without networks nothing is left to follow.
    EXPECT_EQ(record.estimate.motion.state, TrackState::lost) << i;
    EXPECT_FALSE(record.estimate.note.empty()) << i;
  }
}

}  // namespace
}  // namespace telemime
