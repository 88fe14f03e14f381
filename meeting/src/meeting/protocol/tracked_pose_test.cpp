// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/tracked_pose.h"

#include <gtest/gtest.h>

#include "telemime/outputs/testing_motion.h"

namespace telemime::meeting {
namespace {

TEST(BoneConfidence, FallsWithTheDeviation) {
  EXPECT_EQ(confidence_of(0.0), 15);
  EXPECT_EQ(confidence_of(0.02), 15);
  EXPECT_EQ(confidence_of(0.11), 8) << "half way";
  EXPECT_EQ(confidence_of(0.2), 1);
  EXPECT_EQ(confidence_of(100.0), 1);
  for (double deviation = 0.0; deviation < 0.3; deviation += 0.001) {
    EXPECT_GE(confidence_of(deviation), confidence_of(deviation + 0.001));
  }
}

class TrackedPose : public ::testing::Test {
 protected:
  HumanoidMotion motion() const {
    return humanoid_motion(header_.body, frame_.pose, frame_.pose.root - Eigen::Vector3d(0.1, 0.0, 0.0));
  }
  StreamHeader header_ = testing_motion::header();
  MotionFrame frame_ = testing_motion::gesture(header_, 10)[7];
};

TEST_F(TrackedPose, HasTheBonesThatAreTracked) {
  const HumanoidMotion given = motion();
  const PoseFrame frame = pose_frame_of(given, std::nullopt);
  EXPECT_TRUE(frame.tracked);
  EXPECT_EQ(frame.mask, 0x1FFFU) << "hips to hands";
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(frame.hips[axis], 1000.0 * given.hips[static_cast<Eigen::Index>(axis)], 0.5001);
  }
  for (std::size_t bone = 0; bone < kHumanBoneCount; ++bone) {
    EXPECT_EQ(frame.confidence[bone], 0);
    if (frame.has(bone)) {
      EXPECT_LT(frame.rotation[bone].angularDistance(given.rotation[bone]), 1e-12);
    }
  }
}

TEST_F(TrackedPose, EachBoneHasTheConfidenceOfItsJoint) {
  PoseSpread spread;
  spread.covariance.fill(Eigen::Matrix3d::Zero());
  // The wrist: only in depth, 0.11 m of mean square deviation over three axes.
  spread.covariance[static_cast<std::size_t>(Joint::l_wrist)](2, 2) = 3.0 * 0.11 * 0.11;
  spread.covariance[static_cast<std::size_t>(Joint::r_elbow)] = Eigen::Matrix3d::Identity();
  const PoseFrame frame = pose_frame_of(motion(), spread);
  const auto confidence = [&frame](HumanBone bone) {
    return frame.confidence[static_cast<std::size_t>(bone)];
  };
  EXPECT_EQ(confidence(HumanBone::l_lower_arm), 8);
  EXPECT_EQ(confidence(HumanBone::r_upper_arm), 1);
  EXPECT_EQ(confidence(HumanBone::r_lower_arm), 15);
  EXPECT_EQ(confidence(HumanBone::hips), 15);
  EXPECT_EQ(confidence(HumanBone::l_foot), 0) << "not in the mask";
}

TEST_F(TrackedPose, HipsFarAwayStayWithinReach) {
  HumanoidMotion far = motion();
  far.hips = {1000.0, -1000.0, 0.0};
  const PoseFrame frame = pose_frame_of(far, std::nullopt);
  EXPECT_EQ(frame.hips, (std::array<std::int16_t, 3>{32767, -32767, 0}));
}

}  // namespace
}  // namespace telemime::meeting
