// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "telemime/core/random.h"
#include "telemime/outputs/all.h"
#include "telemime/outputs/bvh/skeleton.h"
#include "telemime/outputs/testing_bvh.h"
#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

using namespace testing_bvh;

std::string encoded(const StreamHeader& header, const std::vector<MotionFrame>& frames) {
  return testing_motion::encode_all(*make_bvh_encoder(), header, frames);
}

Eigen::Vector3d place(const std::vector<Eigen::Isometry3d>& world, BvhBone bone) {
  return world[static_cast<std::size_t>(bone)].translation();
}

Eigen::Vector3d end_of(const BvhFile& file, const std::vector<Eigen::Isometry3d>& world, BvhBone bone) {
  const auto b = static_cast<std::size_t>(bone);
  return world[b] * *file.joints[b].end_site;
}

/// m, camera frame, to cm of the file.
Eigen::Vector3d in_file(const Eigen::Vector3d& camera) {
  return 100.0 * (camera_from_body_at_rest() * camera);
}

/// Distance (cm) of the worst of the twelve joints.
double worst_joint(const BvhFile& file, std::size_t f, const JointPositions& joints) {
  const auto world = bvh_world(file, f);
  const std::array<std::pair<Joint, Eigen::Vector3d>, kJointCount> pairs = {{
      {Joint::root, place(world, BvhBone::spine)},
      {Joint::neck, place(world, BvhBone::neck)},
      {Joint::head, place(world, BvhBone::head)},
      {Joint::head_top, end_of(file, world, BvhBone::head)},
      {Joint::l_shoulder, place(world, BvhBone::l_arm)},
      {Joint::r_shoulder, place(world, BvhBone::r_arm)},
      {Joint::l_elbow, place(world, BvhBone::l_forearm)},
      {Joint::r_elbow, place(world, BvhBone::r_forearm)},
      {Joint::l_wrist, place(world, BvhBone::l_hand)},
      {Joint::r_wrist, place(world, BvhBone::r_hand)},
      {Joint::l_hand, end_of(file, world, BvhBone::l_hand)},
      {Joint::r_hand, end_of(file, world, BvhBone::r_hand)},
  }};
  double worst = 0.0;
  for (const auto& [joint, found] : pairs) {
    worst = std::max(worst, (found - in_file(joints[joint])).norm());
  }
  return worst;
}

TEST(Bvh, JointsStandWhereTheMotionFrameHasThem) {
  const StreamHeader header = testing_motion::header();
  std::vector<MotionFrame> frames = testing_motion::gesture(header, 40);
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    frames.push_back(testing_motion::frame_of(header.body, header.camera,
                                              testing_motion::random_pose(header.limits, random),
                                              static_cast<std::int64_t>(frames.size()), header.fps));
  }
  const BvhFile file = parse_bvh(encoded(header, frames));
  EXPECT_NEAR(file.frame_time, 0.04, 1e-9);
  ASSERT_EQ(file.frames.size(), frames.size());
  for (std::size_t f = 0; f < frames.size(); ++f) {
    EXPECT_LT(worst_joint(file, f, frames[f].joints), 0.002) << "frame " << f;  // cm: 0.02 mm
  }
}

TEST(Bvh, FingersAreWhereTheMotionFrameHasThem) {
  StreamHeader header = testing_motion::header();
  header.fingers = true;
  Random random(5);
  std::vector<MotionFrame> frames;
  for (std::int64_t n = 0; n < 60; ++n) {
    frames.push_back(testing_motion::frame_of(
        header.body, header.camera, testing_motion::random_pose(header.limits, random), n, header.fps));
    frames.back().hands = testing_motion::random_hands(header.body, frames.back().pose, random);
  }
  const BvhFile file = parse_bvh(encoded(header, frames));
  ASSERT_EQ(file.joints.size(), kBvhBoneCount + kFingerBoneCount);
  const auto named = [&](const std::string& name) {
    const auto found = std::find_if(file.joints.begin(), file.joints.end(),
                                    [&](const BvhJoint& joint) { return joint.name == name; });
    EXPECT_NE(found, file.joints.end()) << name;
    return static_cast<std::size_t>(found - file.joints.begin());
  };
  for (std::size_t f = 0; f < frames.size(); ++f) {
    const auto world = bvh_world(file, f);
    for (const Side side : {Side::left, Side::right}) {
      const HandPoints& joints = (*frames[f].hands)[static_cast<std::size_t>(side)].joints;
      const std::size_t hand = named(side == Side::left ? "LeftHand" : "RightHand");
      for (std::size_t b = finger_bone(side, 0, 0); b < finger_bone(side, kFingerCount, 0); ++b) {
        const std::size_t bone = named(motion_builder_name(b));
        const auto expect_at = [&](const Eigen::Vector3d& place, std::size_t joint) {
          const Eigen::Vector3d from_wrist = place - world[hand].translation();
          EXPECT_LT((from_wrist - in_file(joints[joint] - joints[0])).norm(), 0.002)
              << motion_builder_name(b);
        };
        expect_at(world[bone].translation(), hand_joint(b / 3 % kFingerCount, b % 3));
        if (const auto& end = file.joints[bone].end_site) {
          expect_at(world[bone] * *end, hand_joint(b / 3 % kFingerCount, 3));
        }
      }
    }
  }
}

TEST(Bvh, RestIsAnUprightTPoseFacingForward) {
  const Body body = make_body(Shape{});
  BvhFile file;
  file.joints = bvh_skeleton(body);
  file.channels.resize(file.joints.size());  // at rest: nothing moves
  file.frames.resize(1);
  const auto world = bvh_world(file, 0);
  const Eigen::Vector3d shoulder = place(world, BvhBone::l_arm);
  const Eigen::Vector3d hand = end_of(file, world, BvhBone::l_hand);
  EXPECT_GT(shoulder.x(), 10.0);  // the person's left is +x
  EXPECT_NEAR(hand.y(), shoulder.y(), 1e-9);
  EXPECT_NEAR(hand.z(), shoulder.z(), 1e-9);
  EXPECT_GT(end_of(file, world, BvhBone::head).y(), place(world, BvhBone::neck).y());
  EXPECT_LT(place(world, BvhBone::l_foot).y(), place(world, BvhBone::l_thigh).y());
  EXPECT_GT(end_of(file, world, BvhBone::l_foot).z(), place(world, BvhBone::l_foot).z());  // toes forward
  const Eigen::Vector3d right = end_of(file, world, BvhBone::r_hand);
  EXPECT_TRUE(right.isApprox(Eigen::Vector3d(-hand.x(), hand.y(), hand.z()), 1e-9));
}

TEST(Bvh, ATPoseHasNoRotationInTheArms) {
  const Body body = make_body(Shape{});
  Pose pose;
  pose[Angle::l_shoulder_abduct] = std::numbers::pi / 2.0;
  pose[Angle::r_shoulder_abduct] = -std::numbers::pi / 2.0;
  const BvhMotion motion = bvh_motion(body, pose);
  for (std::size_t b = 0; b < kBvhBoneCount; ++b) {
    EXPECT_TRUE(motion.parent_from_bone[b].isApprox(Eigen::Matrix3d::Identity(), 1e-9)) << "bone " << b;
  }
}

TEST(Bvh, HeadIsHeldAsTheFaceIs) {
  const Body body = make_body(Shape{});
  Pose pose;
  pose[Angle::root_torsion] = 0.3;
  FaceMotion face;
  face.confidence = 1.0;
  face.head =
      Eigen::AngleAxisd(-0.8, Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX());
  const Eigen::Vector3d nose = face.head * -Eigen::Vector3d::UnitZ();
  BvhMotion motion = bvh_motion(body, pose);
  turn_head(face, motion);
  Eigen::Matrix3d head = Eigen::Matrix3d::Identity();
  for (const BvhBone bone : {BvhBone::hips, BvhBone::spine, BvhBone::spine1, BvhBone::neck, BvhBone::head}) {
    head = head * motion.parent_from_bone[static_cast<std::size_t>(bone)];
  }
  // The file's axes are the camera's with y and z turned round.
  EXPECT_LT((head.col(2) - Eigen::Vector3d(nose.x(), -nose.y(), -nose.z())).norm(), 1e-6);
}

TEST(Bvh, OnlyTheHipsTranslateAndLegsStandStill) {
  const auto joints = bvh_skeleton(make_body(Shape{}));
  const BvhFile file = parse_bvh(encoded(testing_motion::header(), {}));
  ASSERT_EQ(joints.size(), kBvhBoneCount);
  ASSERT_EQ(file.channels.size(), kBvhBoneCount);
  for (std::size_t b = 0; b < joints.size(); ++b) {
    EXPECT_EQ(file.channels[b].size(), b == 0 ? 6U : 3U);
    EXPECT_LT(joints[b].parent, static_cast<int>(b));
  }
  Random random(4);
  const BvhMotion motion =
      bvh_motion(make_body(Shape{}), testing_motion::random_pose(anatomical_limits(), random));
  for (auto b = static_cast<std::size_t>(BvhBone::l_thigh); b < kBvhBoneCount; ++b) {
    EXPECT_TRUE(motion.parent_from_bone[b].isIdentity(0.0));
  }
}

TEST(Bvh, AnglesGoOnPastHalfATurn) {
  const StreamHeader header = testing_motion::header();
  std::vector<MotionFrame> frames;
  for (int t = 0; t < 60; ++t) {
    Pose pose;
    pose[Angle::root_torsion] = 0.1 * t;
    frames.push_back(testing_motion::frame_of(header.body, header.camera, pose, t, header.fps));
  }
  const BvhFile file = parse_bvh(encoded(header, frames));
  for (std::size_t f = 1; f < file.frames.size(); ++f) {
    for (std::size_t c = 3; c < file.frames[f].size(); ++c) {
      EXPECT_LT(std::abs(file.frames[f][c] - file.frames[f - 1][c]), 20.0)
          << "frame " << f << " channel " << c;
    }
  }
}

TEST(Bvh, EveryPrefixOfWholeFramesIsAFile) {
  const StreamHeader header = testing_motion::header();
  const auto frames = testing_motion::gesture(header, 5);
  const auto encoder = make_bvh_encoder();
  std::string text = encoder->begin(header);
  EXPECT_EQ(parse_bvh(text).frames.size(), 0U);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    text += encoder->frame(frames[f]);
    const auto patch = encoder->patch();
    ASSERT_TRUE(patch);
    text.replace(patch->offset, patch->bytes.size(), patch->bytes);
    const BvhFile file = parse_bvh(text);
    EXPECT_EQ(file.frames.size(), f + 1);
  }
}

}  // namespace
}  // namespace telemime
