// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/publishing.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "telemime/outputs/numbers.h"
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

TEST_F(TrackedPose, ContainsTheTrackedBones) {
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

TEST_F(TrackedPose, BonesHaveTheConfidenceOfTheirJoint) {
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

TEST_F(TrackedPose, HipsFarAwayAreLimited) {
  HumanoidMotion far = motion();
  far.hips = {1000.0, -1000.0, 0.0};
  const PoseFrame frame = pose_frame_of(far, std::nullopt);
  EXPECT_EQ(frame.hips, (std::array<std::int16_t, 3>{32767, -32767, 0}));
}

PoseFrame turned(double degrees, std::int16_t hips_x = 0) {
  PoseFrame frame;
  frame.tracked = true;
  frame.mask = 3;
  frame.hips = {hips_x, 900, 0};
  frame.rotation[1] = Eigen::AngleAxisd(degrees / kDegreesPerRadian, Eigen::Vector3d::UnitY());
  return frame;
}

PoseFrame lost() {
  return {};
}

/// Frames that go out in `seconds` when one comes every `interval`, each turned by `step` more degrees.
int sent_in(PublishPace& pace, double seconds, double interval, double step) {
  int sent = 0;
  const auto count = static_cast<int>(std::lround(seconds / interval));
  for (int i = 0; i < count; ++i) {
    const double now = 1000.0 + i * interval;
    const PoseFrame frame = turned(i * step);
    if (pace.due(frame) <= now) {
      pace.sent(frame, now);
      ++sent;
    }
  }
  return sent;
}

TEST(PublishPace, IsSharedByTheParticipants) {
  EXPECT_EQ(publish_rate(0), 30.0);
  EXPECT_EQ(publish_rate(1), 30.0);
  EXPECT_EQ(publish_rate(10), 30.0);
  EXPECT_EQ(publish_rate(15), 20.0);
  EXPECT_EQ(publish_rate(60), 5.0);
  EXPECT_EQ(publish_rate(1000), 5.0);
}

TEST(PublishPace, KeepsItsRateForAnyInputRate) {
  for (const double input : {100.0, 60.0, 47.0}) {
    for (const std::size_t participants : {1U, 12U, 20U, 60U}) {
      PublishPace pace;
      pace.set_participants(participants);
      EXPECT_NEAR(sent_in(pace, 20.0, 1.0 / input, 1.0) / 20.0, publish_rate(participants), 0.2)
          << input << " a second, " << participants;
    }
  }
}

TEST(PublishPace, SlowerFramesAllPass) {
  PublishPace pace;
  EXPECT_EQ(sent_in(pace, 10.0, 1.0 / 25.0, 1.0), 250);
}

TEST(PublishPace, FirstFramePassesAtOnce) {
  PublishPace pace;
  EXPECT_LT(pace.due(turned(0.0)), -1e9);
  EXPECT_FALSE(pace.still(turned(0.0)));
}

TEST(PublishPace, IsTwoPerSecondWithoutMotion) {
  PublishPace pace;
  EXPECT_NEAR(sent_in(pace, 20.0, 0.01, 0.0), 41, 1);
  PublishPace crowded;
  crowded.set_participants(1000);
  EXPECT_NEAR(sent_in(crowded, 20.0, 0.01, 0.0), 41, 1);
}

TEST(PublishPace, MotionAfterARestPassesAtOnce) {
  PublishPace pace;
  pace.sent(turned(0.0), 100.0);
  EXPECT_DOUBLE_EQ(pace.due(turned(0.2)), 100.5);
  EXPECT_LE(pace.due(turned(5.0)), 100.0 + 1e-9);
  EXPECT_TRUE(pace.still(turned(0.2)));
  EXPECT_FALSE(pace.still(turned(5.0)));
  pace.sent(turned(5.0), 100.3);
  pace.sent(turned(9.0), 100.301);
  EXPECT_NEAR(pace.due(turned(15.0)), 100.3 + 1.0 / 30.0, 1e-9) << "a long wait is not made up for";
}

TEST(PublishPace, LateFirstFrameDelaysNoOther) {
  PublishPace pace;
  double longest = 0.0;
  for (int i = 0; i < 300; ++i) {
    const double came = 50.0 + i / 30.0;
    const PoseFrame frame = turned(i);
    const double went = i == 0 ? came + 0.03 : std::max({came, pace.due(frame), i == 1 ? 50.03 : 0.0});
    longest = i < 3 ? longest : std::max(longest, went - came);
    pace.sent(frame, went);
  }
  EXPECT_LT(longest, 1e-6);
}

TEST(PublishPace, StillnessHasBounds) {
  EXPECT_TRUE(is_still(turned(0.0), turned(0.29)));
  EXPECT_FALSE(is_still(turned(0.0), turned(0.31)));
  EXPECT_FALSE(is_still(turned(0.0), turned(-0.31)));
  EXPECT_TRUE(is_still(turned(0.0), turned(0.0, 2)));
  EXPECT_FALSE(is_still(turned(0.0), turned(0.0, 3)));
  EXPECT_FALSE(is_still(turned(0.0), turned(0.0, -3)));
  PoseFrame other = turned(0.0);
  other.hips = {2, 902, 2};  // 3.5 mm
  EXPECT_FALSE(is_still(turned(0.0), other));
  other = turned(0.0);
  other.mask = 1;
  EXPECT_FALSE(is_still(turned(0.0), other));
  EXPECT_FALSE(is_still(turned(0.0), lost()));
  EXPECT_FALSE(is_still(lost(), turned(0.0)));
  EXPECT_TRUE(is_still(lost(), lost()));
  other = turned(0.0);
  other.rotation[1].coeffs() = -other.rotation[1].coeffs();
  EXPECT_TRUE(is_still(turned(0.0), other)) << "the same rotation";
  other.rotation[5] = Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX());
  EXPECT_TRUE(is_still(turned(0.0), other)) << "not in the mask";
}

TEST(PublishPace, FingersAndFaceMoveToo) {
  DetailedFrame before(turned(0.0));
  before.detail.fingers.emplace();
  before.detail.face.emplace();
  EXPECT_TRUE(is_still(before, before));
  const auto moves = [&before](const auto& change) {
    DetailedFrame now = before;
    change(now.detail);
    return !is_still(before, now);
  };
  EXPECT_FALSE(moves([](PoseDetail& d) { d.fingers->at(20) = 2; }));
  EXPECT_TRUE(moves([](PoseDetail& d) { d.fingers->at(20) = -3; }));
  EXPECT_FALSE(moves([](PoseDetail& d) { d.face->arkit[3] = 5; }));
  EXPECT_TRUE(moves([](PoseDetail& d) { d.face->arkit[3] = 6; }));
  EXPECT_TRUE(moves([](PoseDetail& d) { d.face->vrm[3] = 6; }));
  EXPECT_TRUE(moves([](PoseDetail& d) { d.face->gaze[1] = 3; }));
  EXPECT_TRUE(moves([](PoseDetail& d) { d.face.reset(); }));
  EXPECT_TRUE(moves([](PoseDetail& d) { d.fingers.reset(); }));
}

TEST(DetailPace, RepeatsWhatDoesNotChangeRarely) {
  DetailPace pace;
  PoseDetail detail;
  for (int i = 0; i < 40; ++i) {
    EXPECT_FALSE(pace.take(detail)) << "no hands and no face: never";
  }
  detail.fingers.emplace();
  int taken = 0;
  for (int i = 0; i < 45; ++i) {
    ++detail.sequence;
    taken += pace.take(detail) ? 1 : 0;
  }
  EXPECT_EQ(taken, 3) << "every 15th";
  detail.fingers->at(7) = 1;
  EXPECT_TRUE(pace.take(detail));
  detail.fingers.reset();
  EXPECT_TRUE(pace.take(detail)) << "readers must know that the fingers are gone";
  EXPECT_FALSE(pace.take(detail));
}

}  // namespace
}  // namespace telemime::meeting
