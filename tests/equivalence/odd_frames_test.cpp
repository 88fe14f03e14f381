// SPDX-License-Identifier: Apache-2.0
// Images with little information: empty, unknown, without edges.
#include "equivalence/every_backend.h"

namespace telemime::equivalence {
namespace {

constexpr Tolerance kUsual = {0.0001, 0.06, 0.001, 0.25, 18, 18};

class OddFrames : public EveryBackend {
 protected:
  OddFrames() {
    Random random(1);
    for (int i = 0; i < 60; ++i) {
      poses_.push_back(random_pose(anatomical_limits(), random));
    }
    seen_ = support::observe(model_, poses_.front(), camera_);
  }
  Deviations compared_with(const FrameFeatures& seen) {
    return compared(prepare(seen, camera_), model_, poses_);
  }

  const Model model_ = make_model(Shape{});
  const Camera camera_ = camera_of(160, 120);
  std::vector<Pose> poses_;
  FrameFeatures seen_;
};
INSTANTIATE_TEST_SUITE_P(Backends, OddFrames, ::testing::ValuesIn(kBackends), name_of);

TEST_P(OddFrames, OneClassEmptyOrEverywhere) {
  for (const int label : {0, 1, 2, 3}) {
    seen_.labels.setTo(label);
    expect_within("everywhere_" + std::to_string(label), compared_with(seen_), kUsual);
  }
  for (const int label : {1, 2, 3}) {
    FrameFeatures seen = support::observe(model_, poses_.front(), camera_);
    seen.labels.setTo(0, seen.labels == label);
    expect_within("without_" + std::to_string(label), compared_with(seen), kUsual);
  }
}

TEST_P(OddFrames, NothingIsKnown) {
  for (const int label : {4, 5, 63, 127, 128, 129, 254, 255}) {
    seen_.labels.setTo(label);
    const PreparedFrame frame = prepare(seen_, camera_);
    const std::array<std::int32_t, kSurfaceClassCount> none{};
    for (const Score& score : scores_of(*backend_, frame, model_, poses_)) {
      EXPECT_EQ(score.region(), 0.0) << label;
      EXPECT_EQ(score.reductions.observed, none);
      EXPECT_EQ(score.reductions.model, none);
      EXPECT_EQ(score.reductions.both, none);
    }
    expect_within("unknown_" + std::to_string(label), compared_with(seen_), kUsual);
  }
}

TEST_P(OddFrames, EveryLabelThatThereIs) {
  Random random(2);
  for (int y = 0; y < seen_.labels.rows; ++y) {
    for (int x = 0; x < seen_.labels.cols; ++x) {
      if (random.below(2) == 0) {
        seen_.labels.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(random.below(256));
      }
    }
  }
  expect_within("every_label", compared_with(seen_), kUsual);
}

TEST_P(OddFrames, ConstantDistance) {
  for (const float distance : {0.0F, 1.0F, 20.0F, 1000.0F}) {
    seen_.distance.setTo(distance);
    const PreparedFrame frame = prepare(seen_, camera_);
    for (const Score& score : scores_of(*backend_, frame, model_, poses_)) {
      EXPECT_NEAR(score.contour(), distance, 1e-5 * distance);
    }
    expect_within("distance_" + std::to_string(distance), compared_with(seen_), kUsual);
  }
}

TEST_P(OddFrames, NoiseEverywhere) {
  Random random(3);
  for (int y = 0; y < seen_.labels.rows; ++y) {
    for (int x = 0; x < seen_.labels.cols; ++x) {
      seen_.labels.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(random.below(4));
      seen_.distance.at<float>(y, x) = static_cast<float>(random.uniform(0.0, 20.0));
    }
  }
  expect_within("noise", compared_with(seen_), kUsual);
}

}  // namespace
}  // namespace telemime::equivalence
