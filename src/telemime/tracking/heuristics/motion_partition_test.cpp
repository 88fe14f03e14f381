// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/motion_partition.h"

#include <gtest/gtest.h>

#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

using testing_scene::both_arms_seen;
using testing_scene::kDegree;
using testing_scene::Scene;

PartSet only(Part part) {
  return PartSet().set(static_cast<std::size_t>(part));
}

// Parts that move when the person changes from one pose to the other.
PartSet moving(const Pose& before, const Pose& now) {
  Scene scene;
  scene.estimate = before;
  scene.labels_before = frame_of_model(scene.model, before, scene.camera).labels;
  scene.show(now);
  Generation generation;
  generation.moving = all_parts();
  find_moving_parts(scene.context(), generation);
  return generation.moving;
}

// Held to the side, away from the trunk.
Pose arm_aside(Side side, double degrees) {
  Pose pose = both_arms_seen();
  const double sign = side == Side::left ? 1.0 : -1.0;
  set_arm_angles(pose, side, {0.0, 0.0, sign * degrees * kDegree, -10 * kDegree});
  return pose;
}

TEST(MotionPartition, WithoutMotionNoPartMoves) {
  EXPECT_EQ(moving(both_arms_seen(), both_arms_seen()), PartSet());
}

TEST(MotionPartition, OneArmMovesAlone) {
  EXPECT_EQ(moving(arm_aside(Side::left, 60), arm_aside(Side::left, 75)), only(Part::left_arm));
  EXPECT_EQ(moving(arm_aside(Side::right, 60), arm_aside(Side::right, 75)), only(Part::right_arm));
}

TEST(MotionPartition, TheHeadMovesAlone) {
  Pose now = both_arms_seen();
  now[Angle::neck_roll] += 20 * kDegree;
  EXPECT_EQ(moving(both_arms_seen(), now), only(Part::head));
}

TEST(MotionPartition, WhenTheTrunkMovesEverythingDoes) {
  Pose now = both_arms_seen();
  now.root.x() += 0.08;
  EXPECT_EQ(moving(both_arms_seen(), now), all_parts());
}

TEST(MotionPartition, HeadAndArmsMoveWithTheTrunk) {
  Scene scene;
  scene.labels_before = scene.frame.labels.clone();
  // Only some of the chest below the neck disappears.
  const JointPositions joints = scene.joints(both_arms_seen());
  const Eigen::Vector2d neck = scene.camera.project(joints[Joint::neck]);
  const Eigen::Vector2d root = scene.camera.project(joints[Joint::root]);
  cv::Mat chest = scene.frame.labels(cv::Rect(static_cast<int>(neck.x()) - 3, static_cast<int>(neck.y()) + 8,
                                              7, static_cast<int>(root.y() - neck.y()) - 16));
  chest.setTo(0);
  const auto shares =
      uncovered_shares(scene.labels_before, scene.frame.labels, scene.model, scene.estimate, scene.camera);
  EXPECT_GT(shares[static_cast<std::size_t>(Part::trunk)], 0.05);
  EXPECT_EQ(shares[static_cast<std::size_t>(Part::head)], 0.0);
  EXPECT_EQ(shares[static_cast<std::size_t>(Part::left_arm)], 0.0);
  Generation generation;
  generation.moving = PartSet();
  find_moving_parts(scene.context(), generation);
  EXPECT_EQ(generation.moving, all_parts());
}

TEST(MotionPartition, WithoutAFrameBeforeEverythingMoves) {
  Scene scene;
  Generation generation;
  find_moving_parts(scene.context(), generation);
  EXPECT_EQ(generation.moving, all_parts());
  scene.labels_before = cv::Mat::zeros(10, 10, CV_8UC1);  // of another size
  find_moving_parts(scene.context(), generation);
  EXPECT_EQ(generation.moving, all_parts());
}

TEST(MotionPartition, SharesCountPixelsThatLostTheirClass) {
  Scene scene;
  const Pose pose = both_arms_seen();
  const cv::Mat before = scene.frame.labels;
  const auto shares = [&](const cv::Mat& now) {
    return uncovered_shares(before, now, scene.model, pose, scene.camera);
  };
  for (const double share : shares(before)) {
    EXPECT_EQ(share, 0.0);
  }
  for (const double share : shares(cv::Mat::zeros(before.size(), CV_8UC1))) {
    EXPECT_EQ(share, 1.0) << "all of them";
  }
  // Every other column disappears: half of the pixels of the head.
  cv::Mat now = before.clone();
  for (int x = 0; x < now.cols; x += 2) {
    now.col(x).setTo(0);
  }
  EXPECT_NEAR(shares(now)[static_cast<std::size_t>(Part::head)], 0.5, 0.1);
  EXPECT_NEAR(shares(now)[static_cast<std::size_t>(Part::trunk)], 0.5, 0.1);
}

TEST(MotionPartition, APartThatIsNotWhereItWasCountsAsMoving) {
  Scene scene;
  const cv::Mat nothing = cv::Mat::zeros(scene.frame.labels.size(), CV_8UC1);
  for (const double share : uncovered_shares(nothing, nothing, scene.model, both_arms_seen(), scene.camera)) {
    EXPECT_EQ(share, 1.0);
  }
}

}  // namespace
}  // namespace telemime
