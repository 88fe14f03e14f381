// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/pose_message.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

using nlohmann::json;

class PoseMessage : public ::testing::Test {
 protected:
  MotionFrame frame_of(const Pose& pose) const {
    return testing_motion::frame_of(header_.body, header_.camera, pose, 12, header_.fps);
  }
  static Eigen::Quaterniond quaternion(const json& q) {
    return {q.at(3).get<double>(), q.at(0).get<double>(), q.at(1).get<double>(), q.at(2).get<double>()};
  }
  static Eigen::Vector3d vector(const json& v) {
    return {v.at(0).get<double>(), v.at(1).get<double>(), v.at(2).get<double>()};
  }
  StreamHeader header_ = testing_motion::header();
};

TEST_F(PoseMessage, TheBodyIsTheSkeletonInItsTPose) {
  header_.extra["scale_from"] = "the height given";
  const json body = json::parse(PoseMessages(header_).body());
  EXPECT_EQ(body["type"], "body");
  EXPECT_EQ(body["stature"], 1.7);
  EXPECT_EQ(body["scale_from"], "the height given");
  EXPECT_EQ(body["bones"].size(), kHumanBoneCount);
  const HumanoidSkeleton skeleton = humanoid_skeleton(header_.body);
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    EXPECT_LT((vector(body["bones"][std::string(kHumanBoneNames[b])]) - skeleton.position[b]).norm(), 1e-4);
  }
  EXPECT_GT(body["bones"]["leftHand"][0], 0.3) << "x is to the person's own left";
}

TEST_F(PoseMessage, WhatWasPassedOverCountsAsTheFirstFrame) {
  Random random(8);
  PoseMessages told(header_);
  PoseMessages passed(header_);
  const MotionFrame first = frame_of(testing_motion::random_pose(header_.limits, random));
  MotionFrame second = frame_of(testing_motion::random_pose(header_.limits, random));
  second.pose.root.x() += 0.3;
  told.pose(first, 0.0);
  passed.pass(first);
  EXPECT_EQ(passed.pose(second, 0.0), told.pose(second, 0.0));
  EXPECT_NE(PoseMessages(header_).pose(second, 0.0), told.pose(second, 0.0));
}

TEST_F(PoseMessage, APoseHasTheFingersOfTrackedHands) {
  Random random(7);
  MotionFrame frame = frame_of(testing_motion::random_pose(header_.limits, random));
  frame.hands.emplace();
  (*frame.hands)[1].angles[4] = 1.0;
  place_hands(forward_kinematics(header_.body, frame.pose), *frame.hands);
  const json pose = json::parse(PoseMessages(header_).pose(frame, 0.0));
  EXPECT_EQ(pose["bones"].size(), 13U + kFingerBoneCount);
  const Eigen::Quaterniond index = quaternion(pose["bones"]["rightIndexProximal"]);
  EXPECT_NEAR(Eigen::AngleAxisd(index).angle(), 1.0, 0.01);
}

TEST_F(PoseMessage, APoseHasTheRotationsJointsAndPixels) {
  Random random(6);
  PoseMessages messages(header_);
  Eigen::Vector3d origin;
  for (int n = 0; n < 20; ++n) {
    const MotionFrame frame = frame_of(testing_motion::random_pose(header_.limits, random));
    if (n == 0) {
      origin = frame.pose.root;
    }
    const json pose = json::parse(messages.pose(frame, 1234.5678));
    const HumanoidMotion motion = humanoid_motion(header_.body, frame.pose, origin);
    EXPECT_EQ(pose["frame"], 12);
    EXPECT_EQ(pose["time"], 0.48);
    EXPECT_EQ(pose["stamp"], 1234.568);
    EXPECT_EQ(pose["state"], "tracking");
    EXPECT_LT((vector(pose["hips"]) - motion.hips).norm(), 1e-4);
    EXPECT_EQ(pose["bones"].size(), 13U) << "without the legs";
    for (const auto& [name, q] : pose["bones"].items()) {
      const auto* const found = std::find(kHumanBoneNames.begin(), kHumanBoneNames.end(), name);
      ASSERT_NE(found, kHumanBoneNames.end());
      const auto bone = static_cast<std::size_t>(found - kHumanBoneNames.begin());
      EXPECT_LT(quaternion(q).angularDistance(motion.rotation[bone]), 1e-5) << name;
    }
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const std::string name(kJointNames[j]);
      EXPECT_LT((vector(pose["joints"][name]) - 1000.0 * frame.joints.at[j]).norm(), 0.01);
      EXPECT_NEAR(pose["pixels"][name][0], frame.pixels[j].x(), 0.01);
      EXPECT_NEAR(pose["pixels"][name][1], frame.pixels[j].y(), 0.01);
    }
    EXPECT_FALSE(pose.contains("spread") || pose.contains("second_mode"));
  }
}

TEST_F(PoseMessage, FaceHasTheExpressionsOfArkitAndVrm) {
  MotionFrame frame = testing_motion::frame_of(header_.body, header_.camera, Pose{}, 0, header_.fps);
  frame.face.emplace();
  frame.face->confidence = 1.0;
  frame.face->gaze = {0.25, -0.125};
  (*frame.face)[Expression::jaw_open] = 0.6;
  const auto message = nlohmann::json::parse(PoseMessages(header_).pose(frame, 0.0));
  const auto& face = message["face"];
  EXPECT_EQ(face["gaze"], (std::vector<double>{0.25, -0.125}));
  ASSERT_EQ(face["arkit"].size(), kExpressionCount);
  EXPECT_EQ(face["arkit"][static_cast<std::size_t>(Expression::jaw_open)], 0.6);
  EXPECT_EQ(face["vrm"]["aa"], 1.0);
  EXPECT_EQ(face["vrm"]["blinkLeft"], 0.0);
}

TEST_F(PoseMessage, SpreadInSquareMillimetres) {
  MotionFrame frame = frame_of({});
  frame.spread.emplace();
  frame.spread->covariance.fill(Eigen::Matrix3d::Identity());
  frame.spread->second_mode = 0.25;
  frame.spread->covariance[static_cast<std::size_t>(Joint::l_wrist)] << 1e-4, 2e-6, 3e-6, 2e-6, 4e-4, 5e-6,
      3e-6, 5e-6, 9e-4;
  const json pose = json::parse(PoseMessages(header_).pose(frame, 0.0));
  EXPECT_EQ(pose["spread"]["l_wrist"], (json{100.0, 2.0, 3.0, 400.0, 5.0, 900.0}));
  EXPECT_EQ(pose["second_mode"], 0.25);
}

TEST_F(PoseMessage, GoldenFrameAtRest) {
  EXPECT_EQ(
      PoseMessages(header_).pose(frame_of({}), 1234.5),
      R"({"type":"pose","frame":12,"time":0.48,"stamp":1234.5,"state":"tracking","hips":[0.0,0.8194,0.0],)"
      R"("bones":{"hips":[0.0,0.0,0.0,1.0],"spine":[0.0,0.0,0.0,1.0],"chest":[0.0,0.0,0.0,1.0],)"
      R"("neck":[0.0,0.0,0.0,1.0],"head":[0.0,0.0,0.0,1.0],)"
      R"("leftShoulder":[-0.017321,0.0,-0.115058,0.993208],)"
      R"("leftUpperArm":[0.012248,0.012248,-0.620945,0.783662],)"
      R"("leftLowerArm":[0.0,0.0,0.0,1.0],"leftHand":[0.0,0.0,0.0,1.0],)"
      R"("rightShoulder":[-0.017321,0.0,0.115058,0.993208],)"
      R"("rightUpperArm":[0.012248,-0.012248,0.620945,0.783662],)"
      R"("rightLowerArm":[0.0,0.0,0.0,1.0],"rightHand":[0.0,0.0,0.0,1.0]},)"
      R"("joints":{"root":[0.0,0.0,1200.0],"neck":[0.0,-578.0,1200.0],"head":[0.0,-683.4,1159.2],)"
      R"("head_top":[0.0,-829.6,1159.2],"l_shoulder":[178.5,-476.0,1189.8],)"
      R"("r_shoulder":[-178.5,-476.0,1189.8],"l_elbow":[178.5,-204.0,1189.8],)"
      R"("r_elbow":[-178.5,-204.0,1189.8],"l_wrist":[178.5,49.3,1189.8],)"
      R"("r_wrist":[-178.5,49.3,1189.8],"l_hand":[178.5,156.4,1189.8],)"
      R"("r_hand":[-178.5,156.4,1189.8]},"pixels":{"root":[319.5,239.5],"neck":[319.5,-27.47],)"
      R"("head":[319.5,-87.26],"head_top":[319.5,-157.16],"l_shoulder":[402.65,17.76],)"
      R"("r_shoulder":[236.35,17.76],"l_elbow":[402.65,144.47],"r_elbow":[236.35,144.47],)"
      R"("l_wrist":[402.65,262.47],"r_wrist":[236.35,262.47],"l_hand":[402.65,312.36],)"
      R"("r_hand":[236.35,312.36]},"F":0.25,"D_C":1.5})");
}

TEST_F(PoseMessage, LostFramesAreShort) {
  MotionFrame frame = frame_of({});
  frame.state = TrackState::lost;
  EXPECT_EQ(PoseMessages(header_).pose(frame, 5.0),
            R"({"type":"pose","frame":12,"time":0.48,"stamp":5.0,"state":"lost"})");
}

TEST_F(PoseMessage, NumbersThatAreNotFiniteNeverAppear) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  PoseMessages messages(header_);
  const auto check = [&](const MotionFrame& frame, const std::string& state) {
    const std::string text = messages.pose(frame, nan);
    EXPECT_EQ(text.find("null"), std::string::npos) << text;
    EXPECT_EQ(json::parse(text)["state"], state);
  };
  MotionFrame frame = frame_of({});
  frame.pixels[3].x() = infinity;
  frame.region_score = nan;
  frame.time = nan;
  frame.spread.emplace();
  frame.spread->covariance.fill(Eigen::Matrix3d::Constant(nan));
  check(frame, "tracking");
  frame = frame_of({});
  frame.pose.angles[5] = nan;
  check(frame, "lost");
  frame = frame_of({});
  frame.joints.at[2].z() = infinity;
  check(frame, "lost");
  frame = frame_of({});
  frame.pose.root.x() = -infinity;
  check(frame, "lost");
  check(frame_of({}), "tracking");
}

}  // namespace
}  // namespace telemime
