// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/pose_detail.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "meeting/protocol/publishing.h"
#include "telemime/core/errors.h"
#include "telemime/core/random.h"
#include "telemime/outputs/numbers.h"
#include "telemime/outputs/testing_motion.h"

namespace telemime::meeting {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Hands with all angles anywhere within their limits.
HandMotions any_hands(Random& random) {
  HandMotions hands;
  for (HandMotion& hand : hands) {
    for (std::size_t a = 0; a < kHandAngleCount; ++a) {
      hand.angles[a] = random.uniform(hand_limits()[a].min, hand_limits()[a].max);
    }
  }
  return hands;
}

FingerRotations any_fingers(Random& random) {
  const StreamHeader header = testing_motion::header();
  MotionFrame frame = testing_motion::gesture(header, 1)[0];
  frame.hands = any_hands(random);
  return *humanoid_motion(header.body, frame, frame.pose.root).fingers;
}

PoseDetail any_detail(Random& random) {
  PoseDetail detail;
  detail.session = static_cast<std::uint16_t>(1 + random.below(UINT16_MAX));
  detail.sequence = static_cast<std::uint32_t>(random.bits());
  if (random.below(4) != 0) {
    detail.fingers = quantised(any_fingers(random));
  }
  if (random.below(4) != 0) {
    detail.face = quantised(testing_motion::random_face(random));
  }
  return detail;
}

void expect_same(const PoseDetail& a, const PoseDetail& b) {
  EXPECT_EQ(a.session, b.session);
  EXPECT_EQ(a.sequence, b.sequence);
  EXPECT_EQ(a.fingers, b.fingers);
  EXPECT_EQ(a.face, b.face);
}

TEST(PoseDetail, IsReadAsWritten) {
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const PoseDetail detail = any_detail(random);
    const auto back = decode_pose_detail(encode(detail));
    ASSERT_TRUE(back) << name_of(back.fault());
    expect_same(detail, *back);
  }
}

TEST(PoseDetail, FingersAreWithinTwoDegrees) {
  Random random(2);
  double worst = 0.0;
  double worst_tip = 0.0;
  for (int i = 0; i < 500; ++i) {
    const FingerRotations meant = any_fingers(random);
    const FingerRotations sent = rotations_of(quantised(meant));
    for (std::size_t first = 0; first < kFingerBoneCount; first += 3) {
      Eigen::Quaterniond a = Eigen::Quaterniond::Identity();
      Eigen::Quaterniond b = a;
      for (std::size_t bone = first; bone < first + 3; ++bone) {
        worst = std::max(worst, meant[bone].angularDistance(sent[bone]) * kDegreesPerRadian);
        a = a * meant[bone];
        b = b * sent[bone];
        worst_tip = std::max(worst_tip, a.angularDistance(b) * kDegreesPerRadian);
      }
    }
  }
  EXPECT_LT(worst, 1.2) << "each bone in its parent";
  EXPECT_LT(worst_tip, 2.0) << "the last bone in the palm";
  EXPECT_GT(worst, 0.3) << "whole degrees";
}

TEST(PoseDetail, FaceIsWithinTwoHundredths) {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const FaceMotion face = testing_motion::random_face(random);
    const FaceDetail sent = quantised(face);
    const auto vrm = vrm_expressions(face);
    for (std::size_t e = 0; e < kExpressionCount; ++e) {
      EXPECT_NEAR(sent.arkit[e] / 255.0, face.expressions[e], 0.002);
    }
    for (std::size_t e = 0; e < kVrmExpressionCount; ++e) {
      EXPECT_NEAR(sent.vrm[e] / 255.0, vrm[e], 0.002);
    }
    for (std::size_t axis = 0; axis < 2; ++axis) {
      EXPECT_NEAR(0.5 * sent.gaze[axis], face.gaze[static_cast<Eigen::Index>(axis)] * kDegreesPerRadian,
                  0.251);
    }
    EXPECT_NEAR(sent.confidence / 255.0, face.confidence, 0.002);
  }
  FaceMotion far;
  far.gaze = {4.0, -4.0};
  EXPECT_EQ(quantised(far).gaze, (std::array<std::int8_t, 2>{127, -127}));
}

TEST(PoseDetail, FrameAndDetailFitTheirBudget) {
  Random random(4);
  PoseDetail detail;
  EXPECT_EQ(encode(detail).size(), kPoseDetailHead);
  detail.fingers = quantised(any_fingers(random));
  EXPECT_EQ(encode(detail).size(), 58U);
  detail.face = quantised(testing_motion::random_face(random));
  EXPECT_EQ(encode(detail).size(), 130U);
  PoseFrame frame;
  frame.tracked = true;
  frame.mask = kTrackedBones;
  EXPECT_EQ(encode(frame).size() + encode(detail).size(), 241U) << "at most 256 bytes a frame";
}

TEST(PoseDetail, EveryOtherSizeIsRejected) {
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    Bytes bytes = encode(any_detail(random));
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      EXPECT_FALSE(decode_pose_detail(std::span(bytes).first(size)));
    }
    bytes.push_back(0);
    EXPECT_FALSE(decode_pose_detail(bytes));
  }
}

TEST(PoseDetail, NoiseIsReadOrRejected) {
  Random random(6);
  int read = 0;
  for (int i = 0; i < 4'000; ++i) {
    Bytes bytes = encode(any_detail(random));
    for (int flips = 0; flips < 3; ++flips) {
      bytes[random.below(bytes.size())] ^= static_cast<std::uint8_t>(1U << random.below(8));
    }
    const auto detail = decode_pose_detail(bytes);
    if (detail) {
      ++read;
      const auto again = decode_pose_detail(encode(*detail));
      ASSERT_TRUE(again);
      expect_same(*detail, *again);
    }
  }
  EXPECT_GT(read, 200);
  EXPECT_LT(read, 3'800);
}

TEST(PoseDetail, ClientsOfVersion1DropIt) {
  Random random(7);
  for (int i = 0; i < 100; ++i) {
    const auto read = decode_pose_frame(encode(any_detail(random)));
    ASSERT_FALSE(read);
    EXPECT_EQ(read.fault(), PoseFault::unknown_version);
  }
}

TEST(PoseDetail, InvalidOnesAreNotWritten) {
  PoseDetail detail;
  detail.session = 0;
  EXPECT_THROW(encode(detail), Error);
  detail.session = 1;
  detail.fingers.emplace()[49] = kMostFingerDegrees + 1;
  EXPECT_THROW(encode(detail), Error);
  detail.fingers->back() = kMostFingerDegrees;
  EXPECT_NO_THROW(encode(detail));
}

}  // namespace
}  // namespace telemime::meeting
