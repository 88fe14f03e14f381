// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/humanoid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "telemime/body/arm_parts.h"
#include "telemime/body/rotations.h"
#include "telemime/outputs/t_pose.h"
#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

constexpr double kRight = std::numbers::pi / 2.0;

Pose t_pose() {
  Pose pose;
  pose[Angle::l_shoulder_abduct] = kRight;
  pose[Angle::r_shoulder_abduct] = -kRight;
  return pose;
}

Eigen::Vector3d joint(const Body& body, const Pose& pose, HumanBone bone) {
  return humanoid_joints(humanoid_skeleton(body),
                         humanoid_motion(body, pose, pose.root))[static_cast<std::size_t>(bone)];
}

Eigen::Quaterniond world_rotation(const HumanoidMotion& motion, HumanBone bone) {
  Eigen::Quaterniond world = Eigen::Quaterniond::Identity();
  for (int b = static_cast<int>(bone); b >= 0; b = kHumanBoneParent[static_cast<std::size_t>(b)]) {
    world = motion.rotation[static_cast<std::size_t>(b)] * world;
  }
  return world;
}

TEST(Humanoid, StandsInATPoseOnTheFloor) {
  const HumanoidSkeleton s = humanoid_skeleton(make_body(Shape{}));
  const auto end = [&s](HumanBone b) { return s.end[static_cast<std::size_t>(b)]; };
  EXPECT_NEAR(end(HumanBone::l_foot).y(), 0.0, 1e-12);
  EXPECT_NEAR(end(HumanBone::head).y(), 1.70, 0.05) << "as tall as the person";
  EXPECT_GT(end(HumanBone::l_foot).z(), 0.1) << "toes forward";
  EXPECT_NEAR(end(HumanBone::l_hand).y(), s.position[static_cast<std::size_t>(HumanBone::l_upper_arm)].y(),
              1e-12);
  EXPECT_GT(end(HumanBone::l_hand).x(), 0.6);
  for (std::size_t b = 1; b < kHumanBoneCount; ++b) {
    EXPECT_LT(kHumanBoneParent[b], static_cast<int>(b)) << "parents first";
  }
}

TEST(Humanoid, TheTPoseIsTheRestPose) {
  const Body body = make_body(Shape{});
  const HumanoidMotion motion = humanoid_motion(body, t_pose(), t_pose().root);
  const HumanoidSkeleton skeleton = humanoid_skeleton(body);
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    EXPECT_NEAR(motion.rotation[b].angularDistance(Eigen::Quaterniond::Identity()), 0.0, 1e-9)
        << kHumanBoneNames[b];
    EXPECT_NEAR((humanoid_joints(skeleton, motion)[b] - skeleton.position[b]).norm(), 0.0, 1e-9)
        << kHumanBoneNames[b];
  }
}

TEST(Humanoid, AnArmThatPointsAtTheCameraPointsForward) {
  const Body body = make_body(Shape{});
  Pose pose = t_pose();
  pose[Angle::l_shoulder_abduct] = 0.0;
  pose[Angle::l_shoulder_flexion] = -kRight;
  const Eigen::Vector3d arm =
      joint(body, pose, HumanBone::l_hand) - joint(body, pose, HumanBone::l_upper_arm);
  EXPECT_GT(arm.normalized().z(), 0.999);
  EXPECT_GT(joint(body, pose, HumanBone::l_hand).x(), 0.0) << "the person's left is the avatar's left";
}

TEST(Humanoid, AStepTowardTheCameraIsAStepForward) {
  const Body body = make_body(Shape{});
  Pose pose = t_pose();
  const Eigen::Vector3d origin = pose.root;
  pose.root += Eigen::Vector3d(0.1, -0.05, -0.3);
  const Eigen::Vector3d step =
      humanoid_motion(body, pose, origin).hips - humanoid_motion(body, t_pose(), origin).hips;
  EXPECT_NEAR((step - Eigen::Vector3d(0.1, 0.05, 0.3)).norm(), 0.0, 1e-12);
}

TEST(Humanoid, JointsAndHandsAreWhereThePersonsAre) {
  const Body body = make_body(Shape{});
  const JointLimits limits = anatomical_limits();
  const HumanoidSkeleton skeleton = humanoid_skeleton(body);
  const Eigen::Matrix3d world_from_camera = camera_from_body_at_rest().transpose();
  Random random(7);
  double worst = 0.0;
  for (int i = 0; i < 300; ++i) {
    const Pose pose = testing_motion::random_pose(limits, random);
    const Kinematics k = forward_kinematics(body, pose);
    const HumanoidMotion motion = humanoid_motion(body, pose, pose.root);
    const auto joints = humanoid_joints(skeleton, motion);
    const Eigen::Vector3d root = joints[static_cast<std::size_t>(HumanBone::spine)];
    const auto expect = [&](Joint theirs, HumanBone ours, double tolerance) {
      const Eigen::Vector3d place = root + world_from_camera * (k.joints[theirs] - k.joints[Joint::root]);
      const double error = (joints[static_cast<std::size_t>(ours)] - place).norm();
      worst = std::max(worst, error);
      EXPECT_LT(error, tolerance) << kHumanBoneNames[static_cast<std::size_t>(ours)];
    };
    expect(Joint::neck, HumanBone::neck, 1e-9);
    expect(Joint::head, HumanBone::head, 1e-9);
    for (const auto& [theirs, ours] : {std::pair{Joint::l_elbow, HumanBone::l_lower_arm},
                                       {Joint::r_elbow, HumanBone::r_lower_arm},
                                       {Joint::l_wrist, HumanBone::l_hand},
                                       {Joint::r_wrist, HumanBone::r_hand}}) {
      expect(theirs, ours, 0.010);
    }
    for (const auto& [segment, bone, side] :
         {std::tuple{Segment::l_hand, HumanBone::l_hand, 1.0}, {Segment::r_hand, HumanBone::r_hand, -1.0}}) {
      const Eigen::Matrix3d hand = world_from_camera * k[segment].linear() * rotation_z(-side * kRight);
      EXPECT_NEAR(world_rotation(motion, bone).angularDistance(Eigen::Quaterniond(hand)), 0.0, 1e-6);
    }
  }
  RecordProperty("worst_mm", std::to_string(1000.0 * worst));
}

TEST(Humanoid, TheMirroredPoseIsTheMirroredAvatar) {
  const Body body = make_body(Shape{});
  Random random(3);
  const Pose pose = testing_motion::random_pose(anatomical_limits(), random);
  const HumanoidMotion seen = humanoid_motion(body, mirrored(pose), pose.root);
  const HumanoidMotion own = humanoid_motion(body, pose, pose.root);
  const auto expect_mirrored = [&](HumanBone a, HumanBone b) {
    const Eigen::Quaterniond& q = own[a];
    EXPECT_NEAR(seen[b].angularDistance(Eigen::Quaterniond(q.w(), q.x(), -q.y(), -q.z())), 0.0, 1e-6)
        << kHumanBoneNames[static_cast<std::size_t>(a)];
  };
  expect_mirrored(HumanBone::spine, HumanBone::spine);
  expect_mirrored(HumanBone::neck, HumanBone::neck);
  expect_mirrored(HumanBone::l_upper_arm, HumanBone::r_upper_arm);
  expect_mirrored(HumanBone::l_lower_arm, HumanBone::r_lower_arm);
  expect_mirrored(HumanBone::r_hand, HumanBone::l_hand);
}

TEST(Humanoid, HeadIsHeldAsTheFaceIs) {
  const Body body = make_body(Shape{});
  Pose pose;
  pose[Angle::root_torsion] = 0.3;
  FaceMotion face;
  // Turned to the person's left by 0.8: about the axis down.
  face.head = Eigen::AngleAxisd(-0.8, Eigen::Vector3d::UnitY());
  const Eigen::Vector3d nose = face.head * -Eigen::Vector3d::UnitZ();
  const HumanoidMotion before = humanoid_motion(body, pose, pose.root);
  for (const double confidence : {0.0, 1.0}) {
    face.confidence = confidence;
    HumanoidMotion motion = before;
    turn_head(face, motion);
    using enum HumanBone;
    const Eigen::Vector3d forward =
        motion[hips] * motion[spine] * motion[chest] * motion[neck] * motion[head] * Eigen::Vector3d::UnitZ();
    if (confidence == 0.0) {
      EXPECT_LT(motion[neck].angularDistance(before[neck]), 1e-9);
      EXPECT_LT(motion[head].angularDistance(before[head]), 1e-9);
    } else {
      // The world's axes are the camera's with y and z turned round.
      EXPECT_LT((forward - Eigen::Vector3d(nose.x(), -nose.y(), -nose.z())).norm(), 1e-6);
    }
  }
}

TEST(Humanoid, FingersFollowTheHandModel) {
  const Body body = make_body(Shape{});
  Random random(12);
  MotionFrame frame;
  frame.pose = testing_motion::random_pose(anatomical_limits(), random);
  frame.hands.emplace();
  const Kinematics k = forward_kinematics(body, frame.pose);
  for (HandMotion& hand : *frame.hands) {
    hand.sizes = average_hand(body.shape.stature);
    for (std::size_t a = 0; a < kHandAngleCount; ++a) {
      hand.angles[a] = random.uniform(hand_limits()[a].min, hand_limits()[a].max);
    }
  }
  place_hands(k, *frame.hands);
  const HumanoidMotion motion = humanoid_motion(body, frame, frame.pose.root);
  const FingerSkeleton skeleton = finger_skeleton(*frame.hands);
  ASSERT_TRUE(motion.fingers);
  // Forward kinematics of the bones: the joints in the frame of the hand's bone.
  for (std::size_t side = 0; side < 2; ++side) {
    const Eigen::Matrix3d t = t_pose_from_rest(static_cast<Side>(side));
    const Eigen::Isometry3d from_camera =
        forward_kinematics(body, with_wrists(frame.pose, *frame.hands))[kArmParts[side].hand].inverse();
    for (std::size_t f = 0; f < kFingerCount; ++f) {
      Eigen::Vector3d at = Eigen::Vector3d::Zero();
      Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
      for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t bone = finger_bone(static_cast<Side>(side), f, i);
        at += turn * skeleton.offset(bone);
        turn = turn * (*motion.fingers)[bone];
        const Eigen::Vector3d joint = t * (from_camera * (*frame.hands)[side].joints[hand_joint(f, i)]);
        EXPECT_LT((at - joint).norm(), 1e-9) << kFingerBoneNames[bone];
      }
    }
  }
}

}  // namespace
}  // namespace telemime
