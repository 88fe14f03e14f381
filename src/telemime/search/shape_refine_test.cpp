// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/shape_refine.h"

#include <gtest/gtest.h>

#include "telemime/body/arm_ik.h"
#include "telemime/body/testing_poses.h"

namespace telemime {
namespace {

using testing_poses::kDegree;

Pose with_arms(double abduct, double elbow) {
  Pose pose;
  pose.root = {0.0, 0.35, 1.5};
  set_arm_angles(pose, Side::left, {-20 * kDegree, 0.0, abduct, elbow});
  set_arm_angles(pose, Side::right, {-20 * kDegree, 0.0, -abduct, elbow});
  return pose;
}

Keyframe keyframe(const Pose& pose, double region) {
  Keyframe k;
  k.frame.camera = camera_from_field_of_view(160, 120, 60.0);
  k.pose = pose;
  k.region = region;
  return k;
}

TEST(PickKeyframes, TakesThoseFarthestApart) {
  const Body body = make_body(Shape{});
  std::vector<Keyframe> candidates;
  for (const double abduct : {20.0, 21.0, 22.0, 50.0, 23.0, 80.0}) {
    candidates.push_back(keyframe(with_arms(abduct * kDegree, -60 * kDegree), 0.1));
  }
  EXPECT_EQ(pick_keyframes(body, candidates, 3), (std::vector<std::size_t>{0, 3, 5}));
  EXPECT_EQ(pick_keyframes(body, candidates, 1), std::vector<std::size_t>{0});
  EXPECT_TRUE(pick_keyframes(body, candidates, 0).empty());
  EXPECT_TRUE(pick_keyframes(body, {}, 3).empty());
}

TEST(PickKeyframes, LeavesOutBadFitsAndArmsThatLeaveTheImage) {
  const Body body = make_body(Shape{});
  std::vector<Keyframe> candidates;
  for (const double abduct : {20.0, 30.0, 40.0, 50.0, 60.0}) {
    candidates.push_back(keyframe(with_arms(abduct * kDegree, -60 * kDegree), 0.1));
  }
  candidates[4].region = 0.3;
  candidates[0].pose.root.x() = 0.9;  // the left arm is outside on the right
  EXPECT_FALSE(shows_arms(body, candidates[0]));
  EXPECT_TRUE(shows_arms(body, candidates[1]));
  const auto picked = pick_keyframes(body, candidates, 5);
  EXPECT_EQ(picked, (std::vector<std::size_t>{1, 2, 3}));
  for (Keyframe& k : candidates) {
    k.pose.root.z() = -1.0;
  }
  EXPECT_TRUE(pick_keyframes(body, candidates, 5).empty()) << "behind the camera";
}

TEST(PickKeyframes, SamePoseOnlyOnce) {
  const std::vector<Keyframe> same(4, keyframe(with_arms(30 * kDegree, -60 * kDegree), 0.1));
  EXPECT_EQ(pick_keyframes(make_body(Shape{}), same, 3), std::vector<std::size_t>{0});
}

TEST(CarryPose, SameBodySamePose) {
  const Body body = make_body(Shape{});
  for (const double elbow : {-10.0, -60.0, -110.0}) {
    const Pose pose = with_arms(40 * kDegree, elbow * kDegree);
    const JointPositions before = forward_kinematics(body, pose).joints;
    const JointPositions after =
        forward_kinematics(body, carry_pose(body, body, pose, anatomical_limits())).joints;
    for (const Joint j : {Joint::l_elbow, Joint::r_elbow, Joint::l_wrist, Joint::r_wrist}) {
      EXPECT_LT((before[j] - after[j]).norm(), 1e-3) << elbow;
    }
  }
}

TEST(CarryPose, LongerArmsKeepTheirPlaceInTheImage) {
  const Camera camera = camera_from_field_of_view(640, 480, 60.0);
  const Body body = make_body(Shape{});
  Shape longer;
  for (const Segment s :
       {Segment::l_upper_arm, Segment::r_upper_arm, Segment::l_forearm, Segment::r_forearm}) {
    longer[s].length = 1.08;
  }
  const Pose pose = with_arms(40 * kDegree, -70 * kDegree);
  const Body other = make_body(longer);
  const Pose carried = carry_pose(body, other, pose, anatomical_limits());
  EXPECT_TRUE(anatomical_limits().contains(carried, 1e-9));
  const JointPositions before = forward_kinematics(body, pose).joints;
  const JointPositions after = forward_kinematics(other, carried).joints;
  for (const Joint j : {Joint::l_elbow, Joint::r_elbow, Joint::l_wrist, Joint::r_wrist}) {
    EXPECT_LT((camera.project(before[j]) - camera.project(after[j])).norm(), 3.0)
        << kJointNames[static_cast<std::size_t>(j)];
  }
  EXPECT_GT((before[Joint::l_elbow] - after[Joint::l_elbow]).norm(), 0.01) << "the depth must give";
}

TEST(CarryPose, ArmsTooShortReachAsFarAsTheyCan) {
  Shape shorter;
  shorter[Segment::l_forearm].length = 0.7;
  const Body body = make_body(Shape{});
  const Body other = make_body(shorter);
  const Pose pose = with_arms(60 * kDegree, -5 * kDegree);
  const Pose carried = carry_pose(body, other, pose, anatomical_limits());
  ASSERT_TRUE(carried.vector().allFinite());
  const JointPositions j = forward_kinematics(other, carried).joints;
  EXPECT_NEAR((j[Joint::l_wrist] - j[Joint::l_elbow]).norm(), other.forearm_length[0], 1e-6);
}

TEST(CarryArms, ArmsStayInTheImageWhenTheTrunkMoves) {
  const Camera camera = camera_from_field_of_view(640, 480, 60.0);
  const Body body = make_body(Shape{});
  const Pose pose = with_arms(40 * kDegree, -70 * kDegree);
  Pose trunk = pose;
  trunk[Angle::root_torsion] += 0.3;
  trunk.root += Eigen::Vector3d(0.02, 0.0, -0.08);  // nearer, so that arms are long enough
  const JointPositions before = forward_kinematics(body, pose).joints;
  const auto seen_off = [&](const Pose& other, Joint j) {
    return (camera.project(before[j]) - camera.project(forward_kinematics(body, other).joints[j])).norm();
  };
  const Pose carried = carry_arms(body, pose, body, trunk, anatomical_limits());
  EXPECT_TRUE(anatomical_limits().contains(carried, 1e-9));
  for (const Joint j : {Joint::l_elbow, Joint::r_elbow, Joint::l_wrist, Joint::r_wrist}) {
    EXPECT_GT(seen_off(trunk, j), 10.0) << "the test must ask for something";
    EXPECT_LT(seen_off(carried, j), 3.0) << kJointNames[static_cast<std::size_t>(j)];
  }
  for (const Angle a : {Angle::root_torsion, Angle::root_roll, Angle::root_tilt, Angle::neck_tilt}) {
    EXPECT_EQ(carried[a], trunk[a]);
  }
  EXPECT_EQ(carried.root, trunk.root);
}

}  // namespace
}  // namespace telemime
