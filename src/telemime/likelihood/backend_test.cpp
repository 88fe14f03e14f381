// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/backend.h"

#include <gtest/gtest.h>

#include <functional>
#include <opencv2/core.hpp>
#include <vector>

#include "telemime/body/testing_poses.h"
#include "telemime/core/testing_errors.h"
#include "telemime/image/edges.h"
#include "telemime/likelihood/cues/contour.h"
#include "telemime/likelihood/cues/region.h"
#include "telemime/render/renderer.h"

namespace telemime {
namespace {

using testing_poses::random_pose;

constexpr double kCap = 20.0;

Pose middle_pose() {
  Pose pose;
  pose.root = {0.0, 0.35, 1.5};
  pose[Angle::l_shoulder_abduct] = 0.6;
  pose[Angle::r_elbow_flexion] = -1.0;
  return pose;
}

// Features of a perfect segmentation of this pose, with edges along the occluding contour.
FrameFeatures observe(const Model& model, const Pose& pose, const Camera& camera) {
  Rendering rendering;
  render(model.mesh, forward_kinematics(model.body, pose), camera, rendering);
  std::vector<Eigen::Vector2f> contour;
  occluding_contour(model.mesh, rendering, contour);
  FrameFeatures seen;
  seen.labels = cv::Mat(camera.height, camera.width, CV_8UC1, rendering.surface.data()).clone();
  seen.silhouette = (seen.labels > 0);
  seen.edges = cv::Mat::zeros(seen.labels.size(), CV_8UC1);
  for (const Eigen::Vector2f& p : contour) {
    seen.edges.at<std::uint8_t>(static_cast<int>(std::lround(p.y())), static_cast<int>(std::lround(p.x()))) =
        255;
  }
  seen.distance = distance_map(seen.edges, kCap);
  return seen;
}

class Likelihood : public ::testing::Test {
 protected:
  std::vector<Score> evaluate(const std::vector<Pose>& poses, Reduction terms = Reduction::all) {
    std::vector<Score> scores(poses.size());
    backend_->evaluate(frame_, model_, poses, terms, scores);
    return scores;
  }

  Camera camera_ = camera_from_field_of_view(160, 120, 60.0);
  Model model_ = make_model(Shape{});
  FrameFeatures seen_ = observe(model_, middle_pose(), camera_);
  PreparedFrame frame_ = prepare(seen_, camera_);
  std::unique_ptr<Backend> backend_ = make_scalar_backend();
};

void expect_same(const Score& a, const Score& b) {
  ASSERT_EQ(a.region(), b.region());
  ASSERT_EQ(a.contour(), b.contour());
  ASSERT_EQ(a.reductions.observed, b.reductions.observed);
  ASSERT_EQ(a.reductions.model, b.reductions.model);
  ASSERT_EQ(a.reductions.both, b.reductions.both);
  ASSERT_EQ(a.reductions.contour_sum, b.reductions.contour_sum);
  ASSERT_EQ(a.reductions.contour_points, b.reductions.contour_points);
}

TEST_F(Likelihood, TruePoseOfAPerfectPictureScoresZero) {
  const Score s = evaluate({middle_pose()}).front();
  EXPECT_EQ(s.region(), 0.0);
  EXPECT_EQ(s.contour(), 0.0);
  EXPECT_GT(s.reductions.contour_points, 100);
  EXPECT_EQ(s.reductions.both, s.reductions.observed);
}

TEST_F(Likelihood, BatchesEqualOneByOne) {
  Random random(1);
  for (const std::size_t size : {0U, 1U, 2U, 3U, 1000U}) {
    std::vector<Pose> poses;
    for (std::size_t i = 0; i < size; ++i) {
      poses.push_back(random_pose(anatomical_limits(), random, 0.5));
    }
    const std::vector<Score> together = evaluate(poses);
    ASSERT_EQ(together.size(), size);
    const auto alone = make_scalar_backend();  // its buffers are still empty
    for (std::size_t i = 0; i < size; ++i) {
      Score one;
      alone->evaluate(frame_, model_, {&poses[i], 1}, Reduction::all, {&one, 1});
      expect_same(together[i], one);
    }
  }
}

TEST_F(Likelihood, ScoresFollowFromTheReductions) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const Score s = evaluate({random_pose(anatomical_limits(), random, 0.5)}).front();
    ASSERT_EQ(s.region(), non_overlapping_ratio(s.reductions));
    ASSERT_EQ(s.contour(), mean_edge_distance(s.reductions, frame_.distance_cap));
    ASSERT_GT(s.region(), 0.0);
    ASSERT_LE(s.contour(), kCap);
  }
}

TEST_F(Likelihood, TermsThatAreNotAskedForKeepTheirDefaults) {
  Pose pose = middle_pose();
  pose.root.x() += 0.05;
  const Score all = evaluate({pose}).front();
  const Score region = evaluate({pose}, Reduction::overlap).front();
  const Score contour = evaluate({pose}, Reduction::contour).front();
  EXPECT_EQ(region.region(), all.region());
  EXPECT_EQ(region.contour(), Score{}.contour());
  EXPECT_EQ(region.reductions.contour_points, 0);
  EXPECT_EQ(contour.contour(), all.contour());
  EXPECT_EQ(contour.region(), Score{}.region());
  EXPECT_GT(all.region(), 0.0);
  EXPECT_GT(all.contour(), 0.0);
}

TEST_F(Likelihood, KnownDistanceMapGivesItsMean) {
  // Distance = column of the pixel: the mean over the contour is the contour's mean column.
  for (int y = 0; y < seen_.distance.rows; ++y) {
    for (int x = 0; x < seen_.distance.cols; ++x) {
      seen_.distance.at<float>(y, x) = static_cast<float>(x);
    }
  }
  frame_ = prepare(seen_, camera_);
  Rendering rendering;
  render(model_.mesh, forward_kinematics(model_.body, middle_pose()), camera_, rendering);
  std::vector<Eigen::Vector2f> contour;
  occluding_contour(model_.mesh, rendering, contour);
  double mean = 0.0;
  for (const Eigen::Vector2f& p : contour) {
    mean += std::round(p.x()) / static_cast<double>(contour.size());
  }
  EXPECT_NEAR(evaluate({middle_pose()}).front().contour(), mean, 1e-9);
  EXPECT_EQ(frame_.distance_cap, 159.0);
}

TEST_F(Likelihood, BodyOutOfThePictureOverlapsNothing) {
  Pose gone = middle_pose();
  gone.root.x() = 20.0;
  Pose behind = middle_pose();
  behind.root.z() = -3.0;
  for (const Score& s : evaluate({gone, behind})) {
    EXPECT_EQ(s.region(), 1.0);
    EXPECT_EQ(s.contour(), frame_.distance_cap);
    EXPECT_EQ(s.reductions.model, (std::array<std::int32_t, kSurfaceClassCount>{}));
  }
}

TEST_F(Likelihood, IgnoredPixelsCountNowhere) {
  const Reductions before = evaluate({middle_pose()}).front().reductions;
  // Half of the image becomes unknown, including pixels of the model.
  seen_.labels(cv::Rect(0, 0, 80, 120)).setTo(255);
  frame_ = prepare(seen_, camera_);
  const Score s = evaluate({middle_pose()}).front();
  EXPECT_EQ(s.region(), 0.0);
  EXPECT_EQ(s.reductions.model, s.reductions.observed);
  EXPECT_EQ(s.reductions.both, s.reductions.observed);
  for (std::size_t c = 0; c < kSurfaceClassCount; ++c) {
    EXPECT_LT(s.reductions.model[c], before.model[c]);
    EXPECT_GT(s.reductions.model[c], 0);
  }
  Pose lowered = middle_pose();  // moves only the arm in the unknown half
  lowered[Angle::r_elbow_flexion] = -0.5;
  lowered[Angle::r_shoulder_abduct] = -0.3;
  EXPECT_EQ(evaluate({lowered}).front().region(), 0.0);
  seen_.labels.setTo(255);
  frame_ = prepare(seen_, camera_);
  EXPECT_EQ(evaluate({middle_pose()}).front().region(), 0.0) << "nothing is known, nothing is wrong";
}

TEST_F(Likelihood, EvaluationLeavesTheFrameAlone) {
  const cv::Mat before = frame_.labels.clone();
  evaluate({middle_pose()});
  EXPECT_EQ(cv::norm(before, frame_.labels), 0.0);
}

TEST_F(Likelihood, PrepareCountsTheLabels) {
  cv::Mat labels = cv::Mat::zeros(120, 160, CV_8UC1);
  labels(cv::Rect(0, 0, 10, 10)).setTo(1);
  labels(cv::Rect(20, 0, 5, 10)).setTo(2);
  labels(cv::Rect(40, 0, 7, 10)).setTo(3);
  labels(cv::Rect(60, 0, 9, 10)).setTo(255);
  seen_.labels = labels;
  EXPECT_EQ(prepare(seen_, camera_).observed, (std::array<std::int32_t, 3>{100, 50, 70}));
}

TEST_F(Likelihood, PrepareTakesPiecesOfBiggerImages) {
  cv::Mat big_labels = cv::Mat::zeros(200, 300, CV_8UC1);
  cv::Mat big_distance(200, 300, CV_32FC1, cv::Scalar(99));
  const cv::Rect piece(30, 40, 160, 120);
  seen_.labels.copyTo(big_labels(piece));
  seen_.distance.copyTo(big_distance(piece));
  seen_.labels = big_labels(piece);
  seen_.distance = big_distance(piece);
  frame_ = prepare(seen_, camera_);
  EXPECT_EQ(evaluate({middle_pose()}).front().region(), 0.0);
  EXPECT_EQ(evaluate({middle_pose()}).front().contour(), 0.0);
}

TEST_F(Likelihood, PrepareRefusesWhatDoesNotMatchTheCamera) {
  const std::vector<std::function<void(FrameFeatures&)>> faults = {
      [](FrameFeatures& o) { o.labels = cv::Mat::zeros(120, 159, CV_8UC1); },
      [](FrameFeatures& o) { o.labels = cv::Mat::zeros(160, 120, CV_8UC1); },
      [](FrameFeatures& o) { o.labels = cv::Mat(); },
      [](FrameFeatures& o) { o.labels.convertTo(o.labels, CV_32FC1); },
      [](FrameFeatures& o) { o.distance = cv::Mat::zeros(60, 80, CV_32FC1); },
      [](FrameFeatures& o) { o.distance.convertTo(o.distance, CV_8UC1); },
      [](FrameFeatures& o) { o.distance = cv::Mat(); },
  };
  for (std::size_t i = 0; i < faults.size(); ++i) {
    FrameFeatures wrong = seen_;
    faults[i](wrong);
    SCOPED_TRACE(i);
    testing_errors::message_of(ErrorKind::usage, [&] { prepare(wrong, camera_); });
  }
}

TEST_F(Likelihood, EvaluateRefusesAnotherNumberOfScores) {
  const std::vector<Pose> poses(3);
  std::vector<Score> scores(2);
  EXPECT_THROW(backend_->evaluate(frame_, model_, poses, Reduction::all, scores), Error);
}

}  // namespace
}  // namespace telemime
