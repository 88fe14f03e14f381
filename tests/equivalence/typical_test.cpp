// SPDX-License-Identifier: Apache-2.0
// Poses and images that occur in tracking.

#include "equivalence/every_backend.h"
#include "lab/experiments/engine.h"

namespace telemime::equivalence {
namespace {

class Typical : public EveryBackend {};
INSTANTIATE_TEST_SUITE_P(Backends, Typical, ::testing::ValuesIn(kBackends), name_of);

std::vector<Pose> random_poses(std::size_t size, Random& random) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < size; ++i) {
    poses.push_back(random_pose(anatomical_limits(), random));
  }
  return poses;
}

TEST_P(Typical, RandomPosesOfThreePeople) {
  const Camera camera = camera_of(160, 120);
  Random random(1);
  Deviations all;
  for (const Model& model : people()) {
    for (int frame = 0; frame < 3; ++frame) {
      const std::vector<Pose> poses = random_poses(200, random);
      compare(frame_of(model, poses.front(), camera), model, poses, all);
    }
  }
  // Every back end must keep 0.005 and 0.15 px in the mean.
  expect_within("random_poses", all, {0.00015, 0.05, 0.03, 0.4, 35, 27});
}

TEST_P(Typical, AllSizesOfImages) {
  const Model model = make_model(Shape{});
  Random random(2);
  struct Case {
    int width, height;
    Tolerance tolerance;
  };
  // Distances grow with the image; in very small images one pixel or its depth can decide about a whole class
  // or most of the contour.
  for (const auto& [width, height, tolerance] :
       {Case{160, 120, {0.00015, 0.06, 0.003, 0.5, 15, 20}},
        Case{320, 240, {0.00015, 0.09, 0.002, 0.5, 40, 25}},
        Case{640, 480, {0.00012, 0.14, 0.002, 0.6, 130, 80}},
        Case{161, 121, {0.00015, 0.06, 0.003, 0.5, 15, 20}}, Case{33, 240, {0.0006, 0.02, 0.02, 0.15, 4, 12}},
        Case{240, 33, {0.015, 0.15, 0.7, 1.5, 27, 15}}, Case{7, 5, {0.008, 0.012, 0.34, 0.45, 2, 100}},
        Case{1, 1, {0.06, 0.0001, 1.0, 0.001, 1, 400}}}) {
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    const std::vector<Pose> poses = random_poses(60, random);
    const Deviations d = compared(frame_of(model, poses.front(), camera_of(width, height)), model, poses);
    expect_within("image_" + size, d, tolerance);
  }
}

TEST_P(Typical, RankPosesNearTheTruthAlike) {
  const Model model = make_model(Shape{});
  const Camera camera = camera_of(160, 120);
  Random random(3);
  double least_region = 1.0;
  double least_contour = 1.0;
  Deviations all;
  for (const Pose& truth : support::gestures()) {
    const PreparedFrame frame = frame_of(model, truth, camera);
    std::vector<Pose> poses;
    for (int i = 0; i < 200; ++i) {
      Pose pose = truth;
      pose.root += Eigen::Vector3d(random.normal(0, 0.005), random.normal(0, 0.005), random.normal(0, 0.02));
      for (double& angle : pose.angles) {
        angle += random.normal(0, 3 * testing_poses::kDegree);
      }
      poses.push_back(anatomical_limits().clamp(pose));
    }
    const std::vector<Score> scores = scores_of(*backend_, frame, model, poses);
    const std::vector<Score> definition = scores_of(*scalar_, frame, model, poses);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      all.add(scores[i], definition[i]);
    }
    const auto correlation = [&](double (Score::*cost)() const) {
      std::vector<double> a;
      std::vector<double> b;
      for (std::size_t i = 0; i < poses.size(); ++i) {
        a.push_back((scores[i].*cost)());
        b.push_back((definition[i].*cost)());
      }
      return spearman(a, b);
    };
    least_region = std::min(least_region, correlation(&Score::region));
    least_contour = std::min(least_contour, correlation(&Score::contour));
  }
  RecordProperty("region", std::to_string(least_region));
  RecordProperty("contour", std::to_string(least_contour));
  expect_within("near_truth", all, {0.0013, 0.012, 0.008, 0.15, 12, 24});
  EXPECT_GE(least_region, 0.99);
  EXPECT_GE(least_contour, 0.99);
}

}  // namespace
}  // namespace telemime::equivalence
