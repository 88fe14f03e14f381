// SPDX-License-Identifier: Apache-2.0
// Labels that fit no pose: the landmarks lead, and the arms stay.
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <vector>

#include "support/needs.h"
#include "telemime/capture/source.h"
#include "telemime/tracker/track_frame.h"

namespace telemime {
namespace {

constexpr unsigned char code(Label label) {
  return static_cast<unsigned char>(label);
}

// A shirt with stripes of the colour of skin, and arms that are seen beside where they are.
void spoil(cv::Mat& labels) {
  constexpr int kStripe = 4;  // rows
  constexpr int kAside = 12;  // columns
  const cv::Mat seen = labels.clone();
  for (int r = 0; r < labels.rows; ++r) {
    for (int c = 0; c < labels.cols; ++c) {
      auto& label = labels.at<unsigned char>(r, c);
      const bool stripe = seen.at<unsigned char>(r, c) == code(Label::clothes) && r / kStripe % 2 == 0;
      if (stripe || (c >= kAside && seen.at<unsigned char>(r, c - kAside) == code(Label::arms))) {
        label = code(Label::arms);
      } else if (label == code(Label::arms)) {
        label = code(Label::background);
      }
    }
  }
}

struct Tracked {
  std::vector<MotionFrame> motion;
  std::vector<double> trust;
};

// The bundled clip, with labels that are wrong from some frame on.
Tracked track(std::size_t frames, std::size_t wrong_from) {
  const auto source = open_source(TELEMIME_SOURCE_DIR "/data/demo/video.mp4");
  Config config;
  config.image.width = 160;
  config.image.height = 120;
  config.image.models = TELEMIME_BUILD_MODELS;
  config.filter.particles = 100;
  config.hands = false;
  config.face = false;
  TrackingRun run = make_tracking_run(config, camera_from_field_of_view(320, 240, 60.0));
  Tracked out;
  for (std::size_t i = 0; i < frames; ++i) {
    const std::optional<Frame> frame = source->next();
    FrameFeatures features = extract(*frame, colour_request(run.state), run.scene);
    if (i >= wrong_from) {
      spoil(features.labels);
    }
    const FrameEstimate estimate = telemime::estimate(features, run.tracker, run.state);
    out.motion.push_back(estimate.motion);
    out.trust.push_back(estimate.prepared->label_reliability);
  }
  return out;
}

class WrongLabels : public support::WithNetworks {};

TEST_F(WrongLabels, AreNotTrusted) {
  constexpr std::size_t kFrames = 45;
  constexpr std::size_t kWrongFrom = 15;
  const Tracked right = track(kFrames, kFrames);
  const Tracked wrong = track(kFrames, kWrongFrom);
  double apart = 0.0;
  for (std::size_t i = 0; i < kFrames; ++i) {
    ASSERT_EQ(wrong.motion[i].state, TrackState::tracking) << i;
    EXPECT_EQ(right.trust[i], 1.0) << i;
    for (const Joint wrist : {Joint::l_wrist, Joint::r_wrist}) {
      apart += (right.motion[i].joints[wrist] - wrong.motion[i].joints[wrist]).norm() / (2.0 * kFrames);
    }
  }
  EXPECT_EQ(wrong.trust[kWrongFrom], 1.0);
  EXPECT_LT(wrong.trust.back(), 0.05);
  EXPECT_LT(apart, 0.06);
}

}  // namespace
}  // namespace telemime
