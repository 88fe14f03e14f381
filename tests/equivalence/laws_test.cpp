// SPDX-License-Identifier: Apache-2.0
// Laws that follow from the geometry, in every back end by itself.
#include "equivalence/every_backend.h"

namespace telemime::equivalence {
namespace {

class Law : public EveryBackend {
 protected:
  std::vector<Pose> poses_near(const Pose& truth, int size, Random& random) const {
    std::vector<Pose> poses;
    for (int i = 0; i < size; ++i) {
      Pose pose = truth;
      for (double& angle : pose.angles) {
        angle += random.normal(0, 6 * testing_poses::kDegree);
      }
      poses.push_back(anatomical_limits().clamp(pose));
    }
    return poses;
  }

  // Deviations between the scores of two batches of this back end.
  static Deviations between(const std::vector<Score>& a, const std::vector<Score>& b) {
    Deviations deviations;
    for (std::size_t i = 0; i < a.size(); ++i) {
      deviations.add(a[i], b[i]);
    }
    return deviations;
  }

  const Model model_ = make_model(Shape{});
};
INSTANTIATE_TEST_SUITE_P(Backends, Law, ::testing::ValuesIn(kBackends), name_of);

TEST_P(Law, ShiftOfImageAndPrincipalPointCancels) {
  // Two sections of a large image; the person is inside both.
  const Camera whole = camera_from_field_of_view(260, 200, 75.0);
  Random random(1);
  for (Pose truth : support::gestures()) {
    truth.root = {0.0, 0.25, 2.4};
    const FrameFeatures seen = support::observe(model_, truth, whole);
    const std::vector<Pose> poses = poses_near(truth, 50, random);
    const auto piece = [&](int x, int y) {
      Camera camera = whole;
      camera.width = 160;
      camera.height = 130;
      camera.cx -= x;
      camera.cy -= y;
      FrameFeatures part;
      part.labels = seen.labels(cv::Rect(x, y, camera.width, camera.height));
      part.distance = seen.distance(cv::Rect(x, y, camera.width, camera.height));
      return scores_of(*backend_, prepare(part, camera), model_, poses);
    };
    const std::vector<Score> first = piece(50, 40);
    for (const Score& score : first) {
      ASSERT_GT(score.reductions.contour_points, 100);
    }
    for (const auto& [x, y] : {std::pair(49, 40), std::pair(50, 43), std::pair(42, 32), std::pair(61, 35)}) {
      expect_within("moved_" + std::to_string(x) + "_" + std::to_string(y), between(piece(x, y), first),
                    {0.00002, 0.0005, 0.001, 0.01, 2, 2});
    }
  }
}

TEST_P(Law, MirrorMirrors) {
  Random random(2);
  for (const Shape& shape : {Shape{}, testing_poses::other_shape()}) {
    const Model model = make_model(shape);
    for (const Pose& truth : support::gestures()) {
      Camera camera = camera_of(160, 120);
      camera.cx += 3.25;
      const FrameFeatures seen = support::observe(model, truth, camera);
      Camera other = camera;
      other.cx = camera.width - 1 - camera.cx;
      FrameFeatures flipped;
      cv::flip(seen.labels, flipped.labels, 1);
      cv::flip(seen.distance, flipped.distance, 1);
      const std::vector<Pose> poses = poses_near(truth, 50, random);
      std::vector<Pose> twins;
      twins.reserve(poses.size());
      for (const Pose& pose : poses) {
        twins.push_back(mirrored(pose));
      }
      // The diagonals of quadrilaterals, which are part of the contour, are not mirrored.
      expect_within("mirrored",
                    between(scores_of(*backend_, prepare(flipped, other), model, twins),
                            scores_of(*backend_, prepare(seen, camera), model, poses)),
                    {0.0015, 0.2, 0.006, 1.2, 10, 120});
    }
  }
}

TEST_P(Law, TwiceThePixelsSayTheSame) {
  Random random(3);
  const Camera small = camera_of(160, 120);
  const Camera large = small.scaled_to(320, 240);
  double most_region = 0.0;
  double most_contour = 0.0;
  for (const Pose& truth : support::gestures()) {
    const std::vector<Pose> poses = poses_near(truth, 50, random);
    const auto a = scores_of(*backend_, frame_of(model_, truth, small), model_, poses);
    const auto b = scores_of(*backend_, frame_of(model_, truth, large), model_, poses);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      most_region = std::max(most_region, std::abs(a[i].region() - b[i].region()));
      most_contour = std::max(most_contour, std::abs(2.0 * a[i].contour() - b[i].contour()));
    }
  }
  RecordProperty("most_region", std::to_string(most_region));
  RecordProperty("most_contour_px", std::to_string(most_contour));
  EXPECT_LE(most_region, 0.025);
  EXPECT_LE(most_contour, 2.5);
}

TEST_P(Law, ScoresStayInTheirRanges) {
  Random random(4);
  for (int i = 0; i < 30; ++i) {
    const Camera camera =
        camera_of(static_cast<int>(1 + random.below(90)), static_cast<int>(1 + random.below(90)));
    FrameFeatures seen;
    seen.labels = cv::Mat(camera.height, camera.width, CV_8UC1);
    seen.distance = cv::Mat(camera.height, camera.width, CV_32FC1);
    for (int y = 0; y < camera.height; ++y) {
      for (int x = 0; x < camera.width; ++x) {
        seen.labels.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(random.below(5));
        seen.distance.at<float>(y, x) = static_cast<float>(random.uniform(0.0, 5.0));
      }
    }
    const PreparedFrame frame = prepare(seen, camera);
    std::vector<Pose> poses;
    for (int k = 0; k < 20; ++k) {
      poses.push_back(random_pose(anatomical_limits(), random));
      poses.back().root *= random.uniform(0.1, 3.0);
    }
    for (const Score& score : scores_of(*backend_, frame, model_, poses)) {
      expect_possible(score, frame);
    }
  }
}

}  // namespace
}  // namespace telemime::equivalence
