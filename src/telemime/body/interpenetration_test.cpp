// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/interpenetration.h"

#include <gtest/gtest.h>

#include "telemime/body/arm_ik.h"
#include "telemime/body/testing_poses.h"

namespace telemime {
namespace {

using testing_poses::kDegree;
using testing_poses::kSides;

double depth(const Body& body, const Pose& pose) {
  return interpenetration(body, forward_kinematics(body, pose));
}

// The same arm on both sides; angles of the left one.
Pose both_arms(const ArmAngles& arm) {
  Pose pose;
  set_arm_angles(pose, Side::left, arm);
  set_arm_angles(pose, Side::right, {arm.flexion, -arm.twisting, -arm.abduct, arm.elbow});
  return pose;
}

TEST(Interpenetration, FreePosesHaveNone) {
  const ArmAngles free[] = {
      {0, 0, 0, 0},                                     // hanging
      {0, 0, 90 * kDegree, 0},                          // out to the sides
      {-90 * kDegree, 0, 0, 0},                         // forward
      {-170 * kDegree, 0, 0, 0},                        // up
      {0, 0, 10 * kDegree, -90 * kDegree},              // forearms forward
      {0, 0, 90 * kDegree, -90 * kDegree},              // out, forearms forward
      {-60 * kDegree, 0, 20 * kDegree, -60 * kDegree},  // gesture
  };
  for (const Shape& shape : {Shape{}, testing_poses::other_shape()}) {
    const Body body = make_body(shape);
    for (const ArmAngles& arm : free) {
      EXPECT_EQ(depth(body, both_arms(arm)), 0.0) << arm.flexion << " " << arm.abduct << " " << arm.elbow;
    }
  }
}

TEST(Interpenetration, ForearmThroughTheChestIsInvalid) {
  const Body body = make_body(Shape{});
  for (const Side side : kSides) {
    const double inward = side == Side::left ? -1.0 : 1.0;
    Pose pose;  // the upper arm hangs, the forearm points across through the belly
    set_arm_angles(pose, side, {0, inward * 90 * kDegree, 0, -90 * kDegree});
    EXPECT_GT(depth(body, pose), kInvalidInterpenetration);
  }
}

TEST(Interpenetration, HandInsideTheHeadIsInvalid) {
  const Body body = make_body(Shape{});
  for (const Side side : kSides) {
    Pose pose;
    const JointPositions j = forward_kinematics(body, pose).joints;
    const Eigen::Vector3d middle = 0.5 * (j[Joint::head] + j[Joint::head_top]);
    const auto arm = solve_arm(body, pose, side, {middle, 0.0}, anatomical_limits());
    ASSERT_TRUE(arm);
    set_arm_angles(pose, side, *arm);
    EXPECT_GT(depth(body, pose), kInvalidInterpenetration);
  }
}

TEST(Interpenetration, ForearmsThroughEachOtherAreInvalid) {
  const Body body = make_body(Shape{});
  Pose pose;
  const JointPositions j = forward_kinematics(body, pose).joints;
  const Eigen::Vector3d before_chest = j[Joint::neck] + Eigen::Vector3d(0, 0.15, -0.35);
  for (const Side side : kSides) {
    const double across = side == Side::left ? -0.08 : 0.08;
    const auto arm =
        solve_arm(body, pose, side, {before_chest + Eigen::Vector3d(across, 0, 0), 0.0}, anatomical_limits());
    ASSERT_TRUE(arm);
    set_arm_angles(pose, side, *arm);
  }
  EXPECT_GT(depth(body, pose), 0.0);
}

TEST(Interpenetration, GrowsWithTheWayIntoTheChest) {  // until the forearm is through its middle
  const Body body = make_body(Shape{});
  double last = 0.0;
  int grown = 0;
  for (double twist = 0.0; twist >= -60.0; twist -= 10.0) {
    Pose pose;
    set_arm_angles(pose, Side::left, {0, twist * kDegree, 0, -90 * kDegree});
    const double now = depth(body, pose);
    EXPECT_GE(now, last - 1e-12);
    grown += now > last ? 1 : 0;
    last = now;
  }
  EXPECT_GE(grown, 3);
}

TEST(Interpenetration, MirroredPosesAreAsDeepAndPlaceDoesNotMatter) {
  const Body body = make_body(testing_poses::other_shape());
  Random random(1);
  int deep = 0;
  for (int i = 0; i < 500; ++i) {
    const Pose pose = testing_poses::random_pose(anatomical_limits(), random);
    const double here = depth(body, pose);
    deep += here > kInvalidInterpenetration ? 1 : 0;
    ASSERT_NEAR(here, depth(body, mirrored(pose)), 1e-9);
    Pose moved = pose;
    moved.root += Eigen::Vector3d(0.3, -0.2, 1.0);
    ASSERT_NEAR(here, depth(body, moved), 1e-9);
  }
  EXPECT_GT(deep, 20) << "the sample must hold both kinds";
  EXPECT_LT(deep, 480);
}

}  // namespace
}  // namespace telemime
