// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/arm_flips.h"

#include <gtest/gtest.h>

#include "telemime/body/interpenetration.h"
#include "telemime/body/testing_poses.h"
#include "telemime/core/camera.h"

namespace telemime {
namespace {

double pixels_apart(const Camera& camera, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (camera.project(a) - camera.project(b)).norm();
}

TEST(ArmFlips, ProjectOntoTheSameElbowsAndWristsInsideTheLimits) {
  const Body body = make_body(Shape{});
  const JointLimits limits = anatomical_limits();
  const Camera camera = camera_from_field_of_view(640, 480, 60.0);
  Random random(1);
  int accepted = 0;
  int most = 0;
  for (int i = 0; i < 1000; ++i) {
    const Pose pose = testing_poses::random_pose(limits, random);
    const JointPositions seen = forward_kinematics(body, pose).joints;
    const std::vector<Pose> flips = kinematic_flips(body, pose, limits);
    most = std::max(most, static_cast<int>(flips.size()));
    for (const Pose& flip : flips) {
      ++accepted;
      EXPECT_TRUE(limits.contains(flip));
      const Kinematics k = forward_kinematics(body, flip);
      for (const Joint j : {Joint::l_elbow, Joint::r_elbow, Joint::l_wrist, Joint::r_wrist}) {
        EXPECT_LT(pixels_apart(camera, k.joints[j], seen[j]), 0.5) << "pose " << i;
      }
      EXPECT_LT((k.joints[Joint::neck] - seen[Joint::neck]).norm(), 1e-9);
    }
  }
  EXPECT_GT(accepted, 1000);
  EXPECT_GE(most, 6);
  EXPECT_LE(most, 15);
}

TEST(ArmFlips, OfAFlipContainThePoseItself) {
  const Body body = make_body(Shape{});
  const JointLimits limits = anatomical_limits();
  Random random(2);
  int found = 0;
  int flipped = 0;
  for (int i = 0; i < 200; ++i) {
    const Pose pose = testing_poses::random_pose(limits, random);
    const JointPositions own = forward_kinematics(body, pose).joints;
    if (interpenetration(body, forward_kinematics(body, pose)) >= kInvalidInterpenetration) {
      continue;
    }
    for (const Pose& flip : arm_flips(body, pose, Side::left, limits)) {
      ++flipped;
      for (const Pose& back : arm_flips(body, flip, Side::left, limits)) {
        const JointPositions again = forward_kinematics(body, back).joints;
        found += (again[Joint::l_elbow] - own[Joint::l_elbow]).norm() < 1e-4 &&
                 (again[Joint::l_wrist] - own[Joint::l_wrist]).norm() < 1e-4;
      }
    }
  }
  ASSERT_GT(flipped, 50);
  // The others' elbow lies where the ray touches the sphere: there, near and far are one.
  EXPECT_GT(found, 0.9 * flipped);
}

TEST(ArmFlips, AnArmParallelToTheImageHasNearlyNone) {
  const Body body = make_body(Shape{});
  const JointLimits limits = anatomical_limits();
  Pose pose;
  pose[Angle::l_shoulder_abduct] = 0.8;
  pose[Angle::l_shoulder_flexion] = -0.3;
  pose[Angle::l_elbow_flexion] = -0.8;
  const std::vector<Pose> flips = arm_flips(body, pose, Side::left, limits);
  ASSERT_FALSE(flips.empty());
  for (const Pose& flip : flips) {
    EXPECT_GT((flip.vector() - pose.vector()).norm(), 0.1);
  }
}

}  // namespace
}  // namespace telemime
