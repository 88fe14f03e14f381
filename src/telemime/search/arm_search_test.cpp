// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/arm_search.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "telemime/body/arm_flips.h"
#include "telemime/body/arm_ik.h"
#include "telemime/body/arm_parts.h"
#include "telemime/body/interpenetration.h"
#include "telemime/body/testing_poses.h"

namespace telemime {
namespace {

using testing_poses::kDegree;
using testing_poses::kSides;
using testing_poses::random_pose;

TEST(RandomArm, KeepsTheLimitsAndTheRestOfThePose) {
  const Body body = make_body(Shape{});
  Random random(1);
  for (const JointLimits& limits : {anatomical_limits(), reference_limits()}) {
    const Pose pose = random_pose(limits, random, 0.3);
    for (const Side side : kSides) {
      const Side other = side == Side::left ? Side::right : Side::left;
      int deep = 0;
      for (int i = 0; i < 200; ++i) {
        const Pose arm = random_arm(body, pose, side, limits, random);
        ASSERT_TRUE(limits.contains(arm));
        ASSERT_EQ(arm.root, pose.root);
        ASSERT_EQ(arm_angles(arm, other).abduct, arm_angles(pose, other).abduct);
        Pose alone = arm;  // the other arm does not count
        set_arm_angles(alone, other, {0, 0, 0, 0});
        deep +=
            interpenetration(body, forward_kinematics(body, alone)) > 2 * kInvalidInterpenetration ? 1 : 0;
      }
      EXPECT_LT(deep, 20) << "arms mostly stay out of the body";
    }
  }
}

TEST(RandomArm, ReachesMostOfTheSpaceBeforeThePerson) {
  const Body body = make_body(Shape{});
  const JointLimits limits = anatomical_limits();
  const Pose pose;
  Random random(2);
  const Eigen::Vector3d goals[] = {{0.0, -0.3, 0.8}, {0.4, -0.3, 1.0}, {0.3, -0.75, 1.15}, {0.35, 0.0, 1.1}};
  for (const Eigen::Vector3d& goal : goals) {
    double nearest = 1e9;
    for (int i = 0; i < 600; ++i) {
      const Pose arm = random_arm(body, pose, Side::left, limits, random);
      nearest = std::min(nearest, (forward_kinematics(body, arm).joints[Joint::l_wrist] - goal).norm());
    }
    EXPECT_LT(nearest, 0.15) << goal.transpose();
  }
}

TEST(RandomArm, SameSeedSameArm) {
  const Body body = make_body(Shape{});
  Random a(3);
  Random b(3);
  for (int i = 0; i < 10; ++i) {
    ASSERT_EQ(random_arm(body, Pose{}, Side::left, anatomical_limits(), a).vector(),
              random_arm(body, Pose{}, Side::left, anatomical_limits(), b).vector());
  }
}

TEST(ForearmFan, TurnsTheForearmAboutTheElbowAlone) {
  const Body body = make_body(testing_poses::other_shape());
  Random random(5);
  EXPECT_TRUE(forearm_fan(body, Pose{}, Side::left, anatomical_limits(), 0, random).empty());
  std::size_t poses = 0;
  for (const JointLimits& limits : {anatomical_limits(), reference_limits()}) {
    for (int i = 0; i < 20; ++i) {
      const Pose pose = random_pose(limits, random, 0.2);
      const JointPositions before = forward_kinematics(body, pose).joints;
      for (const Side side : kSides) {
        for (const Pose& arm : forearm_fan(body, pose, side, limits, 40, random)) {
          ++poses;
          const JointPositions after = forward_kinematics(body, arm).joints;
          ASSERT_TRUE(limits.contains(arm));
          ASSERT_LT(interpenetration(body, forward_kinematics(body, arm)), kInvalidInterpenetration);
          // What is clamped to the limits moves the elbow by some millimetres on the clavicle.
          ASSERT_LT((after[arm_parts(side).elbow] - before[arm_parts(side).elbow]).norm(), 0.06);
          const Side other = side == Side::left ? Side::right : Side::left;
          ASSERT_EQ(after[arm_parts(other).wrist], before[arm_parts(other).wrist]);
        }
      }
    }
  }
  EXPECT_GT(poses, 2 * 20 * 2 * 10U) << "of 40 each";
}

TEST(ForearmFan, HasADirectionNearEveryForwardForearm) {
  const Body body = make_body(Shape{});
  const JointLimits limits = anatomical_limits();
  Random random(6);
  double farthest = 0.0;
  for (int i = 0; i < 100; ++i) {
    Pose pose;
    pose.root = {0, 0.3, 1.5};
    set_arm_angles(pose, Side::left,
                   {-10 * kDegree, random.uniform(-60.0, 60.0) * kDegree, 25 * kDegree,
                    random.uniform(-110.0, -20.0) * kDegree});
    pose = limits.clamp(pose);
    const Eigen::Vector3d wanted = forward_kinematics(body, pose).joints[Joint::l_wrist];
    Pose away = pose;
    ArmAngles hanging = arm_angles(pose, Side::left);
    hanging.elbow = -5 * kDegree;
    set_arm_angles(away, Side::left, hanging);
    double nearest = 1e9;
    for (const Pose& arm : forearm_fan(body, away, Side::left, limits, 60, random)) {
      nearest = std::min(nearest, (forward_kinematics(body, arm).joints[Joint::l_wrist] - wanted).norm());
    }
    farthest = std::max(farthest, nearest);
  }
  EXPECT_LT(farthest, 0.45 * body.forearm_length[0]) << "about 25 degrees";
}

TEST(DepthFlips, LookTheSameButLieElsewhere) {
  const Body body = make_body(Shape{});
  const JointLimits limits = anatomical_limits();
  const Camera camera = camera_from_field_of_view(320, 240, 60.0);
  Random random(4);
  std::size_t flips = 0;
  double pixels = 0.0;
  for (int i = 0; i < 60; ++i) {
    Pose pose = random_pose(limits, random, 0.1);
    for (const Side side : kSides) {
      const JointPositions here = forward_kinematics(body, pose).joints;
      for (const Pose& flip : arm_flips(body, pose, side, limits)) {
        const JointPositions there = forward_kinematics(body, flip).joints;
        ++flips;
        ASSERT_TRUE(limits.contains(flip, 1e-6));
        ASSERT_LT(interpenetration(body, forward_kinematics(body, flip)), kInvalidInterpenetration);
        ASSERT_EQ(flip.root, pose.root);
        // The clavicle moves the shoulder by some centimetres between the two.
        const Joint wrist = arm_parts(side).wrist;
        pixels += (camera.project(there[wrist]) - camera.project(here[wrist])).norm();
        const Joint elbow = arm_parts(side).elbow;
        const double away =
            std::max((there[wrist] - here[wrist]).norm(), (there[elbow] - here[elbow]).norm());
        ASSERT_GT(away, 0.0);
      }
    }
  }
  ASSERT_GT(flips, 20U);
  EXPECT_LT(pixels / static_cast<double>(flips), 12.0) << "px at 320 columns";
}

TEST(DepthFlips, OfAnElbowBeforeTheBodyLiesBehindIt) {
  const Body body = make_body(Shape{});
  for (const Side side : kSides) {
    Pose pose;
    pose.root = {0, 0.3, 1.5};
    const double outward = side == Side::left ? 1.0 : -1.0;
    set_arm_angles(pose, side, {-35 * kDegree, 0.0, outward * 25 * kDegree, -60 * kDegree});
    const auto elbow_ahead = [&](const Pose& p) {
      const JointPositions j = forward_kinematics(body, p).joints;
      return j[arm_parts(side).shoulder].z() - j[arm_parts(side).elbow].z();
    };
    ASSERT_GT(elbow_ahead(pose), 0.1);
    const auto flips = arm_flips(body, pose, side, anatomical_limits());
    EXPECT_TRUE(std::any_of(flips.begin(), flips.end(), [&](const Pose& p) { return elbow_ahead(p) < 0.0; }));
  }
}

}  // namespace
}  // namespace telemime
