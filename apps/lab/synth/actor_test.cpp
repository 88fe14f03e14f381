// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/actor.h"

#include <gtest/gtest.h>

#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

struct Bone {
  Joint a, b;
  double ActorBuild::*length;
};

TEST(Actor, BonesAreRigidInEveryGesture) {
  const ActorBuild build = scaled_build(1.02, 1.0);
  const std::array<Bone, 7> bones = {{{Joint::root, Joint::neck, &ActorBuild::spine},
                                      {Joint::l_shoulder, Joint::l_elbow, &ActorBuild::upper_arm},
                                      {Joint::r_shoulder, Joint::r_elbow, &ActorBuild::upper_arm},
                                      {Joint::l_elbow, Joint::l_wrist, &ActorBuild::forearm},
                                      {Joint::r_elbow, Joint::r_wrist, &ActorBuild::forearm},
                                      {Joint::l_wrist, Joint::l_hand, &ActorBuild::hand},
                                      {Joint::r_wrist, Joint::r_hand, &ActorBuild::hand}}};
  const ActorKinematics rest = actor_kinematics(build, ActorPose{});
  for (std::size_t g = 0; g < kGestureCount; ++g) {
    for (int frame = 0; frame < kGestureFrames; ++frame) {
      const ActorKinematics k = actor_kinematics(build, gesture_pose(static_cast<Gesture>(g), frame, 9));
      for (const Bone& bone : bones) {
        EXPECT_NEAR((k.joints[bone.a] - k.joints[bone.b]).norm(), build.*bone.length, 1e-9);
      }
      // The clavicle and the skull are rigid as well.
      for (const auto& [a, b] :
           {std::pair{Joint::neck, Joint::l_shoulder}, std::pair{Joint::neck, Joint::r_shoulder},
            std::pair{Joint::neck, Joint::head}, std::pair{Joint::head, Joint::head_top}}) {
        EXPECT_NEAR((k.joints[a] - k.joints[b]).norm(), (rest.joints[a] - rest.joints[b]).norm(), 1e-9);
      }
    }
  }
}

TEST(Actor, FacesTheCameraWithItsLeftOnTheRight) {
  const ActorKinematics k = actor_kinematics(ActorBuild{}, ActorPose{});
  EXPECT_GT(k.joints[Joint::l_shoulder].x(), k.joints[Joint::r_shoulder].x());
  EXPECT_GT(k.joints[Joint::l_wrist].x(), k.joints[Joint::r_wrist].x());
  EXPECT_LT(k.joints[Joint::head_top].y(), k.joints[Joint::root].y());
  EXPECT_LT(k.camera_from_head.linear().col(2).z(), -0.9);  // the face looks toward the camera
}

TEST(Actor, SamePoseOfBothArmsIsMirrored) {
  ActorPose pose;
  pose.arms[0].pronation = pose.arms[1].pronation = 0.7;
  const ActorKinematics k = actor_kinematics(ActorBuild{}, pose);
  for (const auto& [l, r] :
       {std::pair{Joint::l_elbow, Joint::r_elbow}, std::pair{Joint::l_wrist, Joint::r_wrist},
        std::pair{Joint::l_hand, Joint::r_hand}}) {
    const Eigen::Vector3d mirrored(-k.joints[r].x(), k.joints[r].y(), k.joints[r].z());
    EXPECT_LT((k.joints[l] - mirrored).norm(), 1e-12);
  }
  for (std::size_t side = 0; side < 2; ++side) {
    EXPECT_TRUE((k.camera_from_hand[side].transpose() * k.camera_from_hand[side]).isIdentity(1e-9));
  }
}

TEST(Actor, PronationTurnsThePalmDown) {
  ActorPose pose;
  for (ActorArm& arm : pose.arms) {
    arm.upper = {0.0, -1.0, 0.0};
    arm.fore = {0.0, 0.0, 1.0};
    arm.extension = 0.0;
  }
  for (const double sign : {1.0, -1.0}) {
    pose.arms[0].pronation = pose.arms[1].pronation = sign * 1.5707963267948966;
    const ActorKinematics k = actor_kinematics(ActorBuild{}, pose);
    for (std::size_t side = 0; side < 2; ++side) {
      // Camera y points down: the back of a pronated hand looks up.
      EXPECT_NEAR(k.camera_from_hand[side](1, 2), -sign, 1e-6);
      // Its thumb points to the middle.
      EXPECT_NEAR(k.camera_from_hand[side](0, 0), (side == 0 ? -1.0 : 1.0) * sign, 1e-6);
    }
  }
}

TEST(Actor, RaisedArmsLiftTheShoulders) {
  ActorPose pose;
  const double rest = actor_kinematics(ActorBuild{}, pose).joints[Joint::l_shoulder].y();
  pose.arms[0].upper = {0.3, 0.95, 0.0};
  EXPECT_LT(actor_kinematics(ActorBuild{}, pose).joints[Joint::l_shoulder].y(), rest - 0.02);
}

TEST(Gesture, StartsAndEndsAtRestAndRepeats) {
  for (std::size_t g = 0; g < kGestureCount; ++g) {
    const auto gesture = static_cast<Gesture>(g);
    const auto keys = gesture_keys(gesture);
    EXPECT_EQ(keys.front().frame, 0.0);
    EXPECT_EQ(keys.back().frame, 164.0);
    EXPECT_EQ(keys.front().left.fore, keys.back().left.fore);
    for (std::size_t i = 1; i < keys.size(); ++i) {
      EXPECT_LT(keys[i - 1].frame, keys[i].frame);
    }
    const Eigen::Vector3d first = gesture_pose(gesture, 0, 4).arms[0].fore;
    const Eigen::Vector3d again = gesture_pose(gesture, 165, 4).arms[0].fore;
    EXPECT_LT((first - again).norm(), 0.15);
  }
}

TEST(Gesture, MovesSmoothlyAndAsFastAsPeopleDo) {
  const std::array<double, kGestureCount> least = {0.02, 0.08, 0.02, 0.04, 0.01};
  for (std::size_t g = 0; g < kGestureCount; ++g) {
    double fastest = 0.0;
    Eigen::Vector3d before = Eigen::Vector3d::Zero();
    for (int frame = 0; frame < kGestureFrames; ++frame) {
      const ActorKinematics k =
          actor_kinematics(ActorBuild{}, gesture_pose(static_cast<Gesture>(g), frame, 2));
      const Eigen::Vector3d& wrist = k.joints[Joint::l_wrist];
      if (frame > 0) {
        fastest = std::max(fastest, (wrist - before).norm());
      }
      before = wrist;
    }
    EXPECT_GT(fastest, least[g]) << kGestureNames[g];
    EXPECT_LT(fastest, 0.20) << kGestureNames[g] << ": m per frame";
  }
}

TEST(Gesture, AnUnknownNameIsRefusedWithTheList) {
  EXPECT_EQ(gesture_named("joy"), Gesture::joy);
  const std::string message = testing_errors::message_of(ErrorKind::usage, [] { gesture_named("dancing"); });
  EXPECT_TRUE(testing_errors::names(message, "raising_arms")) << message;
}

}  // namespace
}  // namespace telemime
