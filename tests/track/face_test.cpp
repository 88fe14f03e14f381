// SPDX-License-Identifier: Apache-2.0
// The face beside the pose, on the demo clip.
#include <gtest/gtest.h>

#include <vector>

#include "support/needs.h"
#include "telemime/capture/source.h"
#include "telemime/tracker/track_frame.h"

namespace telemime {
namespace {

constexpr std::size_t kFrames = 20;

std::vector<MotionFrame> tracked(bool face, int threads) {
  const auto source = open_source(TELEMIME_SOURCE_DIR "/data/demo/video.mp4");
  Config config;
  config.image.width = 160;
  config.image.height = 120;
  config.image.models = TELEMIME_BUILD_MODELS;
  config.filter.particles = 300;
  config.face = face;
  config.hands = false;
  config.threads = threads;
  TrackingRun run = make_tracking_run(config, camera_from_field_of_view(320, 240, 60.0));
  std::vector<MotionFrame> frames;
  for (auto frame = source->next(); frame && frames.size() < kFrames; frame = source->next()) {
    frames.push_back(track_frame(*frame, run).estimate.motion);
  }
  return frames;
}

class SlowFace : public support::WithNetworks {};

TEST_F(SlowFace, PoseIsTheSameWithAndWithoutIt) {
  const auto without = tracked(false, 1);
  const auto with = tracked(true, 1);
  const auto parallel = tracked(true, 4);
  ASSERT_EQ(with.size(), kFrames);
  EXPECT_EQ(with.back().state, TrackState::tracking);
  std::size_t seen = 0;
  for (std::size_t i = 0; i < kFrames; ++i) {
    EXPECT_FALSE(without[i].face) << i;
    EXPECT_EQ(with[i].pose.vector(), without[i].pose.vector()) << i;
    EXPECT_EQ(with[i].pose.vector(), parallel[i].pose.vector()) << i;
    ASSERT_EQ(with[i].face.has_value(), parallel[i].face.has_value()) << i;
    if (with[i].face) {
      ++seen;
      EXPECT_EQ(with[i].face->confidence, parallel[i].face->confidence) << i;
      EXPECT_EQ(with[i].face->head.coeffs(), parallel[i].face->head.coeffs()) << i;
      EXPECT_EQ(with[i].face->gaze, parallel[i].face->gaze) << i;
      EXPECT_EQ(with[i].face->expressions, parallel[i].face->expressions) << i;
    }
  }
  EXPECT_GT(seen, kFrames * 3 / 4);
}

}  // namespace
}  // namespace telemime
