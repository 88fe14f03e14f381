// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/blocks.h"

#include <gtest/gtest.h>

#include "telemime/body/arm_parts.h"
#include "telemime/body/testing_poses.h"

namespace telemime {
namespace {

using testing_poses::bent_pose;
using testing_poses::kDegree;
using testing_poses::kSides;
using testing_poses::random_pose;

constexpr double kTenthOfMillimetre = 1e-4;

double farthest_joint(const Body& body, const Pose& a, const Pose& b) {
  return testing_poses::farthest_joint(forward_kinematics(body, a).joints,
                                       forward_kinematics(body, b).joints);
}

std::vector<SearchBlock> all_blocks(const Body& body, const Pose& pose, const JointLimits& limits) {
  return {whole_block(pose, limits, 1.5),
          trunk_block(body, pose, limits, 1.5),
          arm_block(body, pose, Side::left, limits, 1.5),
          arm_block(body, pose, Side::right, limits, 1.5),
          bones_block(body, pose, Side::left, limits, 1.5),
          bones_block(body, pose, Side::right, limits, 1.5)};
}

TEST(Blocks, StartDecodesToThePose) {
  const Body body = make_body(testing_poses::other_shape());
  const JointLimits limits = anatomical_limits();
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    Pose pose = bent_pose(limits, random);
    if (i % 2 == 0) {  // every other one with arms that are straight, or stretched a little too far
      for (const Side side : kSides) {
        ArmAngles arm = arm_angles(pose, side);
        arm.elbow = random.uniform(-5.0, 5.0) * kDegree;
        set_arm_angles(pose, side, arm);
      }
    }
    for (const SearchBlock& block : all_blocks(body, pose, limits)) {
      ASSERT_LT(farthest_joint(body, block.decode(block.start), pose), kTenthOfMillimetre)
          << "block of " << block.start.size() << ", pose " << i;
    }
  }
}

TEST(Blocks, AWristRightAtTheCameraStaysThere) {
  const Body body = make_body(Shape{});
  const JointLimits limits = anatomical_limits();
  for (const Side side : kSides) {
    Pose pose;
    set_arm_angles(pose, side, {-80 * kDegree, 0.0, 0.0, -10 * kDegree});
    // The root moves until the wrist is 8 cm before the camera, nearer than a search would go.
    pose.root +=
        Eigen::Vector3d(0.02, -0.01, 0.08) - forward_kinematics(body, pose).joints[arm_parts(side).wrist];
    const SearchBlock block = arm_block(body, pose, side, limits, 1.5);
    EXPECT_LT(farthest_joint(body, block.decode(block.start), pose), kTenthOfMillimetre);
    EXPECT_TRUE((block.start.array() >= block.bounds.low.array()).all());
  }
}

TEST(Blocks, SizesAndBoundsFit) {
  const Body body = make_body(Shape{});
  const JointLimits limits = anatomical_limits();
  Random random(2);
  const Pose pose = bent_pose(limits, random);
  const auto blocks = all_blocks(body, pose, limits);
  const Eigen::Index sizes[] = {23, 9, 7, 7, 7, 7};
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const SearchBlock& b = blocks[i];
    EXPECT_EQ(b.start.size(), sizes[i]) << i;
    EXPECT_EQ(b.steps.size(), sizes[i]) << i;
    EXPECT_TRUE((b.steps.array() > 0.0).all()) << i;
    EXPECT_TRUE((b.bounds.low.array() < b.bounds.high.array()).all()) << i;
    EXPECT_TRUE((b.start.array() >= b.bounds.low.array()).all()) << i;
    EXPECT_TRUE((b.start.array() <= b.bounds.high.array()).all()) << i;
  }
}

TEST(Blocks, StepsGrowWithTheFactor) {
  const Body body = make_body(Shape{});
  const JointLimits limits = anatomical_limits();
  Pose pose;
  pose[Angle::l_elbow_flexion] = pose[Angle::r_elbow_flexion] = -1.0;
  EXPECT_TRUE(whole_block(pose, limits, 3.0).steps.isApprox(2.0 * whole_block(pose, limits, 1.5).steps));
  EXPECT_TRUE(arm_block(body, pose, Side::left, limits, 3.0)
                  .steps.isApprox(2.0 * arm_block(body, pose, Side::left, limits, 1.5).steps));
}

TEST(Blocks, WholeBlockIsThePoseVector) {
  Random random(3);
  const JointLimits limits = anatomical_limits();
  const Pose pose = random_pose(limits, random);
  const SearchBlock block = whole_block(pose, limits, 1.0);
  EXPECT_EQ(block.start, Eigen::VectorXd(pose.vector()));
  Eigen::VectorXd x = block.start;
  x[5] += 0.01;
  EXPECT_EQ(Eigen::VectorXd(block.decode(x).vector()), x);
}

TEST(Blocks, TrunkBlockKeepsTheWristsInPlace) {
  const Body body = make_body(Shape{});
  const JointLimits limits = anatomical_limits();
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    Pose pose = bent_pose(limits, random);
    for (const Side side : kSides) {  // well in reach, so that the trunk may move
      ArmAngles arm = arm_angles(pose, side);
      arm.elbow = std::clamp(arm.elbow, -110 * kDegree, -50 * kDegree);
      set_arm_angles(pose, side, arm);
    }
    const SearchBlock block = trunk_block(body, pose, limits, 1.5);
    Eigen::VectorXd x = block.start;
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      x[k] += block.steps[k] * random.uniform(-1.0, 1.0);
    }
    const Pose moved = block.decode(x);
    const JointPositions before = forward_kinematics(body, pose).joints;
    const JointPositions after = forward_kinematics(body, moved).joints;
    EXPECT_TRUE(moved.root.isApprox(x.head<3>()));
    EXPECT_EQ(moved[Angle::root_roll], x[3 + static_cast<int>(Angle::root_roll)]);
    for (const Side side : kSides) {
      ASSERT_LT((after[arm_parts(side).wrist] - before[arm_parts(side).wrist]).norm(), kTenthOfMillimetre)
          << i;
    }
  }
}

TEST(Blocks, ArmBlockMovesItsArmOnly) {
  const Body body = make_body(Shape{});
  const JointLimits limits = anatomical_limits();
  Random random(5);
  for (const Side side : kSides) {
    const Side other = side == Side::left ? Side::right : Side::left;
    const Pose pose = bent_pose(limits, random);
    const SearchBlock block = arm_block(body, pose, side, limits, 1.5);
    const Pose moved = block.decode(block.start + block.steps);
    EXPECT_EQ(moved.root, pose.root);
    EXPECT_EQ(moved[Angle::neck_tilt], pose[Angle::neck_tilt]);
    EXPECT_EQ(arm_angles(moved, other).flexion, arm_angles(pose, other).flexion);
    EXPECT_GT(farthest_joint(body, moved, pose), 0.01);
  }
}

TEST(Blocks, ArmBlockPutsTheWristOnItsRay) {
  const Body body = make_body(Shape{});
  const JointLimits limits = anatomical_limits();
  Pose pose;
  pose[Angle::l_shoulder_flexion] = -40 * kDegree;
  pose[Angle::l_elbow_flexion] = -80 * kDegree;
  const SearchBlock block = arm_block(body, pose, Side::left, limits, 1.5);
  Eigen::VectorXd x = block.start;
  x[0] += 0.02;
  x[1] -= 0.03;
  x[2] -= 0.04;
  const Eigen::Vector3d wrist = forward_kinematics(body, block.decode(x)).joints[Joint::l_wrist];
  EXPECT_LT((wrist - Eigen::Vector3d(x[0] * x[2], x[1] * x[2], x[2])).norm(), kTenthOfMillimetre);
}

TEST(Blocks, WristOutOfReachComesAsNearAsTheArmAllows) {
  const Body body = make_body(Shape{});
  const JointLimits limits = anatomical_limits();
  Pose pose;
  for (const Side side : kSides) {
    const Eigen::Vector3d shoulder = forward_kinematics(body, pose).joints[arm_parts(side).shoulder];
    const Eigen::Vector3d way = Eigen::Vector3d(0.1, 0.2, -1.0).normalized();
    const Pose moved = with_wrist(body, pose, side, {shoulder + 3.0 * way, 0.2}, limits);
    const JointPositions j = forward_kinematics(body, moved).joints;
    const double reach = body.upper_arm_length[0] + body.forearm_length[0];
    EXPECT_GT((j[arm_parts(side).wrist] - j[arm_parts(side).shoulder]).norm(), 0.85 * reach);
    EXPECT_GT((j[arm_parts(side).wrist] - j[arm_parts(side).shoulder]).normalized().dot(way), 0.99);
  }
}

TEST(Blocks, WristInsideTheShoulderStillGivesAPose) {
  const Body body = make_body(testing_poses::other_shape());
  const JointLimits limits = anatomical_limits();
  const Pose pose;
  for (const Side side : kSides) {
    const Eigen::Vector3d shoulder = forward_kinematics(body, pose).joints[arm_parts(side).shoulder];
    for (const Eigen::Vector3d& place : {shoulder, Eigen::Vector3d(shoulder.x(), shoulder.y(), 0.3)}) {
      EXPECT_TRUE(with_wrist(body, pose, side, {place, 0.0}, limits).vector().allFinite());
    }
  }
}

TEST(Blocks, PartMovesItsNumbersAndKeepsTheOthers) {
  const Body body = make_body(Shape{});
  const JointLimits limits = anatomical_limits();
  Random random(9);
  const Pose pose = bent_pose(limits, random);
  const SearchBlock whole = bones_block(body, pose, Side::left, limits, 1.5);
  const SearchBlock fore = part_of(bones_block(body, pose, Side::left, limits, 1.5), 2, 2);
  ASSERT_EQ(fore.start.size(), 2);
  EXPECT_EQ(fore.steps, whole.steps.segment(2, 2));
  EXPECT_EQ(fore.bounds.low, whole.bounds.low.segment(2, 2));
  EXPECT_EQ(fore.bounds.high, whole.bounds.high.segment(2, 2));
  Eigen::VectorXd all = whole.start;
  all.segment(2, 2) << 0.2, -0.3;
  EXPECT_EQ(fore.decode(Eigen::Vector2d(0.2, -0.3)).vector(), whole.decode(all).vector());
}

}  // namespace
}  // namespace telemime
