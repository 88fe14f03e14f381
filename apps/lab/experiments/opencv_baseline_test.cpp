// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/engine_bench.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lab/experiments/engine_agreement.h"
#include "telemime/core/errors.h"
#include "telemime/search/budget.h"

namespace telemime {
namespace {

TEST(OpencvBaseline, BothComeNearToTheDefinition) {
  for (const auto make : {make_opencv_baseline, make_literal_opencv}) {
    const auto opencv = make();
    const auto scalar = make_scalar_backend();
    const Model model = make_model(Shape{});
    for (const Camera& camera : engine_cameras()) {
      Random random(5);
      std::vector<Pose> poses = typical_poses(30, random);
      const PreparedFrame frame = frame_of_model(model, poses.front(), camera);
      std::vector<Score> near(poses.size());
      std::vector<Score> exact(poses.size());
      opencv->evaluate(frame, model, poses, Reduction::all, near);
      scalar->evaluate(frame, model, poses, Reduction::all, exact);
      double mean = 0.0;
      for (std::size_t i = 0; i < poses.size(); ++i) {
        const double difference = std::abs(near[i].region() - exact[i].region());
        mean += difference / static_cast<double>(poses.size());
        // Largest at the true pose, where every differently drawn pixel is an error.
        EXPECT_LT(difference, 0.13) << camera.width << ", pose " << i;
        EXPECT_GT(near[i].reductions.contour_points, exact[i].reductions.contour_points / 3);
        EXPECT_EQ(near[i].reductions.observed, exact[i].reductions.observed);
      }
      EXPECT_LT(mean, 0.05) << camera.width;
      EXPECT_LT(near.front().contour(), near[1].contour()) << "the true pose has the smallest distance";
    }
  }
}

TEST(OpencvBaseline, BodyOutOfThePictureOverlapsNothing) {
  const Model model = make_model(Shape{});
  Random random(5);
  Pose pose = typical_poses(1, random).front();
  const PreparedFrame frame = frame_of_model(model, pose, engine_cameras().front());
  std::vector<Pose> gone = {pose, pose};
  gone[0].root.x() = 20.0;
  gone[1].root.z() = -3.0;
  std::vector<Score> scores(2);
  make_opencv_baseline()->evaluate(frame, model, gone, Reduction::all, scores);
  for (const Score& score : scores) {
    EXPECT_EQ(score.region(), 1.0);
    EXPECT_EQ(score.contour(), frame.distance_cap);
  }
  EXPECT_THROW(make_opencv_baseline()->evaluate(frame, model, gone, Reduction::all, {}), Error);
}

TEST(OpencvBaseline, IgnoredPixelsCountNowhere) {
  const Model model = make_model(Shape{});
  Random random(5);
  const Pose pose = typical_poses(1, random).front();
  PreparedFrame frame = frame_of_model(model, pose, engine_cameras().front());
  frame.labels.setTo(255);
  frame.observed = {};
  Score score;
  make_opencv_baseline()->evaluate(frame, model, {&pose, 1}, Reduction::overlap, {&score, 1});
  EXPECT_EQ(score.region(), 0.0);
}

}  // namespace
}  // namespace telemime
