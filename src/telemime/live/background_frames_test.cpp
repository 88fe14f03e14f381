// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/background_frames.h"

#include <gtest/gtest.h>

#include <limits>
#include <opencv2/core.hpp>

namespace telemime {
namespace {

// The number of frames taken from an endless input with these time stamps.
std::size_t taken(const std::function<double(int)>& time) {
  int count = 0;
  return background_frames(
             [&] {
               Frame frame;
               frame.time = time(count++);
               return std::optional(frame);
             },
             ImageConfig{})
      .size();
}

TEST(BackgroundFrames, AreThoseOfOneSecond) {
  EXPECT_EQ(taken([](int i) { return i / 32.0; }), 33U);
  EXPECT_EQ(taken([](int i) { return 100.0 + i / 16.0; }), 17U) << "whatever the camera states";
}

TEST(BackgroundFrames, AreEightAtLeastAndSixtyAtMost) {
  EXPECT_EQ(taken([](int i) { return i / 5.0; }), 8U);
  EXPECT_EQ(taken([](int i) { return i / 120.0; }), 60U);
}

TEST(BackgroundFrames, OddTimesDoNoHarm) {
  EXPECT_EQ(taken([](int) { return 7.0; }), 60U) << "they stand still";
  EXPECT_EQ(taken([](int i) { return -i; }), 60U) << "they go back";
  EXPECT_EQ(taken([](int i) { return i < 3 ? i / 25.0 : 1e9; }), 8U) << "a gap";
  EXPECT_LE(taken([](int) { return std::numeric_limits<double>::quiet_NaN(); }), 60U);
}

TEST(BackgroundFrames, EndWithTheInput) {
  int left = 3;
  const auto next = [&] { return left-- > 0 ? std::optional(Frame{}) : std::nullopt; };
  EXPECT_EQ(background_frames(next, ImageConfig{}).size(), 3U);
  EXPECT_TRUE(background_frames(next, ImageConfig{}).empty());
}

TEST(BackgroundFrames, OfALargeCameraAreSmall) {
  int left = 10;
  const auto next = [&] {
    Frame frame;
    frame.image = cv::Mat(2160, 3840, CV_8UC3, cv::Scalar(40, 50, 60));
    return left-- > 0 ? std::optional(frame) : std::nullopt;
  };
  for (const Frame& frame : background_frames(next, ImageConfig{})) {
    EXPECT_EQ(frame.image.size(), cv::Size(640, 360));
  }
}

}  // namespace
}  // namespace telemime
