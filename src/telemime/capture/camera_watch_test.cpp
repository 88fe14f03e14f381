// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/camera_watch.h"

#include <gtest/gtest.h>

#include <vector>

namespace telemime {
namespace {

using Kind = SourceNews::Kind;

bool says(const std::optional<SourceNews>& news, Kind kind, const std::string& words) {
  return news && news->kind == kind && news->words.find(words) != std::string::npos;
}

// The reports while `count` images arrive at `rate` per second, starting at `time`.
std::vector<SourceNews> at_rate(CameraWatch& watch, double& time, int count, double rate) {
  std::vector<SourceNews> told;
  for (int i = 0; i < count; ++i) {
    time += 1.0 / rate;
    if (auto news = watch.rate(time)) {
      told.push_back(*news);
    }
  }
  return told;
}

TEST(CameraWatch, ReportsLowFrameRateOnceAndItsEnd) {
  CameraWatch watch({640, 480}, 100.0);
  double time = 100.0;
  EXPECT_TRUE(at_rate(watch, time, 100, 25.0).empty());
  auto told = at_rate(watch, time, 50, 5.0);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_TRUE(says(told[0], Kind::worse, "only 5 frames per second"));
  told = at_rate(watch, time, 100, 25.0);
  ASSERT_EQ(told.size(), 1U);
  EXPECT_TRUE(says(told[0], Kind::better, "25 frames per second again"));
}

TEST(CameraWatch, IgnoresGapsAndEqualTimes) {
  CameraWatch watch({640, 480}, 0.0);
  double time = 0.0;
  at_rate(watch, time, 100, 25.0);
  time += 1000.0;
  EXPECT_TRUE(at_rate(watch, time, 100, 25.0).empty());
  for (int i = 0; i < 100; ++i) {
    EXPECT_FALSE(watch.rate(time));
  }
}

TEST(CameraWatch, ReportsChangesOfSize) {
  CameraWatch watch({640, 480}, 0.0);
  EXPECT_FALSE(watch.size({640, 480}));
  EXPECT_TRUE(says(watch.size({320, 240}), Kind::worse, "320x240"));
  EXPECT_FALSE(watch.size({320, 240}));
  const auto wide = watch.size({1280, 720});
  EXPECT_TRUE(says(wide, Kind::worse, "another aspect ratio"));
  EXPECT_TRUE(says(watch.size({640, 480}), Kind::better, "640x480"));
}

TEST(CameraWatch, ReportsRepeatedDamage) {
  CameraWatch watch({640, 480}, 0.0);
  EXPECT_FALSE(watch.damaged(1.0));
  EXPECT_FALSE(watch.damaged(11.0));
  EXPECT_FALSE(watch.damaged(21.0)) << "now and then one";
  EXPECT_FALSE(watch.whole(21.5));
  EXPECT_FALSE(watch.damaged(22.0));
  EXPECT_TRUE(says(watch.damaged(22.1), Kind::worse, "damaged"));
  EXPECT_FALSE(watch.damaged(22.2));
  EXPECT_FALSE(watch.whole(24.0));
  EXPECT_TRUE(says(watch.whole(25.3), Kind::better, "no longer damaged"));
  EXPECT_FALSE(watch.whole(26.0));
  EXPECT_EQ(watch.summary(), "6 damaged images were dropped");
}

TEST(CameraWatch, ReportsInterruptionsAndTheirEnd) {
  CameraWatch watch({640, 480}, 10.0);
  EXPECT_FALSE(watch.back(11.0));
  EXPECT_TRUE(says(watch.stopped(12.0), Kind::worse, "trying to open it again"));
  EXPECT_TRUE(says(watch.silent(), Kind::gone, "no images"));
  EXPECT_FALSE(watch.silent());
  EXPECT_FALSE(watch.stopped(20.0)) << "opened, and stopped without a picture";
  EXPECT_TRUE(says(watch.back(31.0), Kind::better, "20.0 s"));
  EXPECT_EQ(watch.summary(), "it stopped once, last after 2.0 s; it was opened again");
  EXPECT_TRUE(says(watch.silent(), Kind::gone, "no images")) << "without a stop, too";
  EXPECT_TRUE(says(watch.back(40.0), Kind::better, "9.0 s"));
  watch.stopped(41.0);
  watch.given_up(8);
  EXPECT_NE(watch.summary().find("2 times"), std::string::npos);
  EXPECT_NE(watch.summary().find("did not come back in 8 attempts"), std::string::npos);
}

}  // namespace
}  // namespace telemime
