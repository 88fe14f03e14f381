// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/arm_ik.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "telemime/body/arm_parts.h"
#include "telemime/body/testing_poses.h"

namespace telemime {
namespace {

using testing_poses::kDegree;
using testing_poses::random_pose;

constexpr double kTenthOfMillimetre = 1e-4;

class ArmIk : public ::testing::TestWithParam<Side> {
 protected:
  ArmIk() : side_(GetParam()), body_(make_body(testing_poses::other_shape())) {}

  Eigen::Vector3d elbow(const Pose& pose) const {
    return forward_kinematics(body_, pose).joints[arm_parts(side_).elbow];
  }
  Eigen::Vector3d wrist(const Pose& pose) const {
    return forward_kinematics(body_, pose).joints[arm_parts(side_).wrist];
  }
  // Sine of the angle between the line from shoulder to wrist and the chest's upright axis.
  double distance_from_pole(const Pose& pose) const {
    const Kinematics k = forward_kinematics(body_, pose);
    const Eigen::Vector3d line = k.joints[arm_parts(side_).wrist] - k.joints[arm_parts(side_).shoulder];
    return line.normalized().cross(Eigen::Vector3d(k[Segment::chest].linear().col(1))).norm();
  }
  // The pose with another arm on this side.
  Pose with_other_arm(const Pose& pose, Random& random) const {
    Pose other = pose;
    set_arm_angles(other, side_, arm_angles(random_pose(limits_, random), side_));
    return other;
  }

  Side side_;
  Body body_;
  JointLimits limits_ = anatomical_limits();
};

INSTANTIATE_TEST_SUITE_P(Sides, ArmIk, ::testing::ValuesIn(testing_poses::kSides),
                         [](const auto& param) { return param.param == Side::left ? "left" : "right"; });

TEST_P(ArmIk, AnglesAreThoseOfTheSide) {
  Pose pose;
  set_arm_angles(pose, side_, {0.1, 0.2, 0.3, -0.4});
  const bool left = side_ == Side::left;
  EXPECT_EQ(pose[left ? Angle::l_shoulder_flexion : Angle::r_shoulder_flexion], 0.1);
  EXPECT_EQ(pose[left ? Angle::l_shoulder_twisting : Angle::r_shoulder_twisting], 0.2);
  EXPECT_EQ(pose[left ? Angle::l_shoulder_abduct : Angle::r_shoulder_abduct], 0.3);
  EXPECT_EQ(pose[left ? Angle::l_elbow_flexion : Angle::r_elbow_flexion], -0.4);
  const ArmAngles other = arm_angles(pose, left ? Side::right : Side::left);
  EXPECT_EQ(other.flexion, 0.0);
  EXPECT_EQ(arm_angles(pose, side_).abduct, 0.3);
}

TEST_P(ArmIk, SolvesAThousandArmsFromTheirTarget) {
  Random random(1);
  int at_pole = 0;
  for (int i = 0; i < 1000; ++i) {
    Pose pose = random_pose(limits_, random);
    // A straight arm has no swivel.
    ArmAngles arm = arm_angles(pose, side_);
    arm.elbow = std::min(arm.elbow, -10 * kDegree);
    set_arm_angles(pose, side_, arm);
    const ArmTarget target = arm_target(body_, pose, side_);
    ASSERT_LT((target.wrist - wrist(pose)).norm(), 1e-12);
    Pose solved = with_other_arm(pose, random);
    const auto angles = solve_arm(body_, solved, side_, target, limits_);
    ASSERT_TRUE(angles) << "arm " << i << " is in reach";
    set_arm_angles(solved, side_, *angles);
    ASSERT_LT((wrist(solved) - wrist(pose)).norm(), kTenthOfMillimetre) << i;
    // Where the wrist is straight above or below the shoulder the swivel has no zero, so that two elbows may
    // fit it.
    if (distance_from_pole(pose) < 0.1) {
      ++at_pole;
      continue;
    }
    ASSERT_LT((elbow(solved) - elbow(pose)).norm(), kTenthOfMillimetre) << i;
    ASSERT_TRUE(limits_.contains(solved, 1e-6)) << "an arm inside the limits exists: " << i;
  }
  EXPECT_LT(at_pole, 20);
}

TEST_P(ArmIk, NearlyStraightArmsKeepTheirWrist) {
  Random random(2);
  for (int i = 0; i < 300; ++i) {
    Pose pose = random_pose(limits_, random);
    ArmAngles arm = arm_angles(pose, side_);
    arm.elbow = i % 2 == 0 ? -0.5 * kDegree : 0.5 * kDegree;
    set_arm_angles(pose, side_, arm);
    const auto angles = solve_arm(body_, pose, side_, arm_target(body_, pose, side_), limits_);
    ASSERT_TRUE(angles) << i;
    Pose solved = pose;
    set_arm_angles(solved, side_, *angles);
    ASSERT_LT((wrist(solved) - wrist(pose)).norm(), kTenthOfMillimetre) << i;
  }
}

TEST_P(ArmIk, FromItsOwnPoseTheArmStays) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    Pose pose = random_pose(limits_, random);
    ArmAngles arm = arm_angles(pose, side_);
    arm.elbow = std::min(arm.elbow, -10 * kDegree);
    arm.flexion = std::clamp(arm.flexion, -80 * kDegree, limits_.max[6]);  // one decomposition, not its twin
    set_arm_angles(pose, side_, arm);
    const auto angles = solve_arm(body_, pose, side_, arm_target(body_, pose, side_), limits_);
    ASSERT_TRUE(angles);
    ASSERT_NEAR(angles->flexion, arm.flexion, 1e-5) << i;
    ASSERT_NEAR(angles->abduct, arm.abduct, 1e-5) << i;
    ASSERT_NEAR(angles->twisting, arm.twisting, 1e-5) << i;
    ASSERT_NEAR(angles->elbow, arm.elbow, 1e-5) << i;
  }
}

TEST_P(ArmIk, StraightArmsKeepTheirTwist) {
  Random random(5);
  for (int i = 0; i < 300; ++i) {
    Pose pose = random_pose(limits_, random, 0.4);
    ArmAngles arm = arm_angles(pose, side_);
    const bool straight = i % 11 == 0;
    arm.elbow = straight ? 0.0 : random.uniform(-5.0, 5.0) * kDegree;
    arm.flexion = std::clamp(arm.flexion, -80 * kDegree, limits_.max[6]);  // one decomposition, not its twin
    set_arm_angles(pose, side_, arm);
    const ArmAngles through = arm_through(body_, pose, side_, elbow(pose), wrist(pose), limits_);
    ASSERT_NEAR(through.twisting, arm.twisting, 1e-3) << i << ", elbow " << arm.elbow;
    ASSERT_NEAR(through.elbow, arm.elbow, 1e-4) << i;
    if (straight) {
      continue;  // its swivel says nothing
    }
    const auto solved = solve_arm(body_, pose, side_, arm_target(body_, pose, side_), limits_);
    ASSERT_TRUE(solved) << i;
    ASSERT_NEAR(solved->twisting, arm.twisting, 1e-3) << i << ", elbow " << arm.elbow;
    ASSERT_NEAR(solved->elbow, arm.elbow, 1e-4) << i;
  }
}

TEST_P(ArmIk, SwivelIsZeroForTheLowestElbowAndTurnsIt) {
  Pose pose;  // the arm forward, the forearm up: the elbow is below the line to the wrist
  set_arm_angles(pose, side_, {-60 * kDegree, 0.0, 0.0, -60 * kDegree});
  const ArmTarget target = arm_target(body_, pose, side_);
  EXPECT_NEAR(target.swivel, 0.0, 1e-9);
  Pose turned = pose;
  double highest = elbow(pose).y();
  for (const double swivel : {45 * kDegree, 90 * kDegree, 135 * kDegree, std::numbers::pi}) {
    const auto angles = solve_arm(body_, pose, side_, {target.wrist, swivel}, limits_);
    ASSERT_TRUE(angles);
    set_arm_angles(turned, side_, *angles);
    EXPECT_LT((wrist(turned) - target.wrist).norm(), kTenthOfMillimetre);
    const double found = arm_target(body_, turned, side_).swivel;
    EXPECT_NEAR(std::remainder(found - swivel, 2 * std::numbers::pi), 0.0, 1e-5);
    EXPECT_LT(elbow(turned).y(), highest - 0.01) << "the elbow rises with the swivel";
    highest = elbow(turned).y();
  }
}

TEST_P(ArmIk, NothingForAWristOutOfReach) {
  const Pose pose;
  const Eigen::Vector3d shoulder = forward_kinematics(body_, pose).joints[arm_parts(side_).shoulder];
  const double reach = body_.upper_arm_length[0] + body_.forearm_length[0];
  const double shortest = std::abs(body_.upper_arm_length[0] - body_.forearm_length[0]);
  const Eigen::Vector3d forward(0, 0, -1);
  EXPECT_FALSE(solve_arm(body_, pose, side_, {shoulder + forward * (reach + 0.1), 0.0}, limits_));
  EXPECT_FALSE(solve_arm(body_, pose, side_, {Eigen::Vector3d(0, 0, 50), 0.0}, limits_));
  EXPECT_TRUE(solve_arm(body_, pose, side_, {shoulder + forward * 0.9 * reach, 0.0}, limits_));
  ASSERT_GT(shortest, 0.02);
  const Eigen::Vector3d hanging_shoulder =
      pose.root + camera_from_body_at_rest() * shoulder_in_chest(body_, side_, {0, -1, 0});
  EXPECT_FALSE(solve_arm(body_, pose, side_, {hanging_shoulder, 0.0}, limits_))
      << "nearer than the arm can fold";
}

TEST_P(ArmIk, ThroughTheJointsGivesTheJointsBack) {
  Random random(4);
  for (int i = 0; i < 500; ++i) {
    const Pose pose = random_pose(limits_, random);
    Pose solved = with_other_arm(pose, random);
    set_arm_angles(solved, side_, arm_through(body_, solved, side_, elbow(pose), wrist(pose), limits_));
    ASSERT_LT((elbow(solved) - elbow(pose)).norm(), kTenthOfMillimetre) << i;
    ASSERT_LT((wrist(solved) - wrist(pose)).norm(), kTenthOfMillimetre) << i;
  }
}

TEST_P(ArmIk, ThroughUsesDirectionsNotLengths) {
  Pose pose;
  set_arm_angles(pose, side_, {-40 * kDegree, 0.0, 0.0, -70 * kDegree});
  const Eigen::Vector3d e = elbow(pose);
  const Eigen::Vector3d w = wrist(pose);
  const ArmAngles angles = arm_through(body_, pose, side_, e, e + 1.7 * (w - e), limits_);
  EXPECT_NEAR(angles.elbow, -70 * kDegree, 1e-6);
  EXPECT_NEAR(angles.flexion, -40 * kDegree, 1e-5);
}

}  // namespace
}  // namespace telemime
