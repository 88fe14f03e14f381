// SPDX-License-Identifier: Apache-2.0
// Properties that do not depend on the pose: sizes of batches, terms, earlier evaluations, numbers that are
// not finite.
#include <gtest/gtest.h>

#include <limits>

#include "equivalence/every_backend.h"
#include "telemime/core/errors.h"
#include "telemime/search/budget.h"

namespace telemime::equivalence {
namespace {

class Batches : public EveryBackend {
 protected:
  static std::vector<Pose> poses_of(std::size_t size) {
    Random random(8);
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < size; ++i) {
      poses.push_back(random_pose(anatomical_limits(), random, 0.5));
    }
    return poses;
  }

  std::vector<Score> evaluate(const std::vector<Pose>& poses, Reduction terms = Reduction::all) {
    std::vector<Score> scores(poses.size(), {{-1.0, -1.0}, {}});
    backend_->evaluate(frame_, model_, poses, terms, scores);
    return scores;
  }

  static void expect_equal(const Score& a, const Score& b) {
    ASSERT_EQ(a.costs, b.costs);
    ASSERT_EQ(a.reductions.model, b.reductions.model);
    ASSERT_EQ(a.reductions.contour_points, b.reductions.contour_points);
  }

  Model model_ = make_model(Shape{});
  PreparedFrame frame_ =
      frame_of_model(model_, poses_of(1).front(), camera_from_field_of_view(160, 120, 60.0));
};

TEST_P(Batches, AnySizeGivesTheScoresOfPosesAlone) {
  for (const std::size_t size : {0U, 1U, 2U, 127U, 128U, 129U, 300U}) {
    const std::vector<Pose> poses = poses_of(size);
    const std::vector<Score> together = evaluate(poses);
    for (std::size_t i = 0; i < size; i += 41) {
      expect_equal(together[i], evaluate({poses[i]}).front());
    }
  }
}

TEST_P(Batches, TermsThatAreNotAskedForKeepTheirDefaults) {
  const std::vector<Pose> poses = poses_of(3);
  const Score all = evaluate(poses)[2];
  const Score region = evaluate(poses, Reduction::overlap)[2];
  const Score contour = evaluate(poses, Reduction::contour)[2];
  EXPECT_EQ(region.region(), all.region());
  EXPECT_EQ(region.contour(), Score{}.contour());
  EXPECT_EQ(contour.contour(), all.contour());
  EXPECT_EQ(contour.region(), Score{}.region());
}

TEST_P(Batches, AnotherNumberOfScoresIsRefused) {
  std::vector<Score> scores(2);
  EXPECT_THROW(backend_->evaluate(frame_, model_, poses_of(3), Reduction::all, scores), Error);
}

TEST_P(Batches, LeaveNoTrace) {
  const std::vector<Pose> poses = poses_of(20);
  const std::vector<Score> before = evaluate(poses);
  const PreparedFrame first = frame_;
  Shape shape = testing_poses::other_shape();
  model_ = make_model(shape);
  frame_ = frame_of_model(model_, poses[1], camera_from_field_of_view(321, 243, 60.0));
  evaluate(poses);
  model_ = make_model(Shape{});
  frame_ = first;
  const std::vector<Score> after = evaluate(poses);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    expect_equal(before[i], after[i]);
  }
}

TEST_P(Batches, NotANumberScoresFiniteAndLeavesNoTrace) {
  const std::vector<Pose> poses = poses_of(10);
  const std::vector<Score> before = evaluate(poses);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  std::vector<Pose> wrong;
  for (const double value : {nan, infinity, -infinity, 1e30, -1e30, 1e13, 1e6}) {
    for (std::size_t i = 0; i < kPoseSize; i += 2) {
      PoseVector v = poses[0].vector();
      v[static_cast<Eigen::Index>(i)] = value;
      wrong.push_back(Pose::from_vector(v));
      v[0] = value;
      v[2] = value;
      wrong.push_back(Pose::from_vector(v));
    }
  }
  for (const Score& score : evaluate(wrong)) {
    ASSERT_TRUE(score.region() >= 0.0 && score.region() <= 1.0);
    ASSERT_TRUE(score.contour() >= 0.0 && score.contour() <= frame_.distance_cap);
  }
  const std::vector<Score> after = evaluate(poses);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    expect_equal(before[i], after[i]);
  }
}

TEST_P(Batches, LargeImageNearTheCamera) {
  frame_ = frame_of_model(model_, poses_of(1).front(), camera_from_field_of_view(1920, 1080, 60.0));
  std::vector<Pose> poses = poses_of(4);
  for (Pose& pose : poses) {
    pose.root.z() = 0.7;
  }
  Deviations deviations;
  compare(frame_, model_, poses, deviations);
  EXPECT_LT(deviations.most_region(), 0.002);
  EXPECT_LT(deviations.most_contour(), 1.0);
}

INSTANTIATE_TEST_SUITE_P(Backends, Batches, ::testing::ValuesIn(kBackends), name_of);

}  // namespace
}  // namespace telemime::equivalence
