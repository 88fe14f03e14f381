// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/mirror.h"

#include <gtest/gtest.h>

#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

// A person whose sides differ.
StreamHeader lopsided() {
  StreamHeader header = testing_motion::header();
  Shape shape;
  shape[Segment::l_upper_arm].length = 1.1;
  shape[Segment::r_forearm].length = 0.9;
  shape[Segment::r_hand].length = 1.2;
  header.body = make_body(shape);
  header.camera.cx = 300.0;
  return header;
}

TEST(Mirror, KinematicsOfTheMirroredAreTheMirroredKinematics) {
  const StreamHeader header = lopsided();
  const StreamHeader other = mirrored(header);
  Random random(4);
  for (int n = 0; n < 50; ++n) {
    const MotionFrame frame = testing_motion::frame_of(
        header.body, header.camera, testing_motion::random_pose(header.limits, random), n, header.fps);
    const MotionFrame seen = mirrored(frame, header.camera);
    const MotionFrame expected =
        testing_motion::frame_of(other.body, other.camera, mirrored(frame.pose), n, header.fps);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      EXPECT_LT((seen.joints.at[j] - expected.joints.at[j]).norm(), 1e-9) << kJointNames[j];
      EXPECT_LT((seen.pixels[j] - expected.pixels[j]).norm(), 1e-6) << kJointNames[j];
    }
  }
}

TEST(Mirror, TwiceIsAsBefore) {
  const StreamHeader header = lopsided();
  auto frame = testing_motion::gesture(header, 1)[0];
  frame.spread.emplace();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    frame.spread->covariance[j] << 1.0, 0.1 * static_cast<double>(j), 0.2, 0.1 * static_cast<double>(j), 2.0,
        0.3, 0.2, 0.3, 3.0;
  }
  Random random(5);
  frame.hands = testing_motion::random_hands(header.body, frame.pose, random);
  frame.face = testing_motion::random_face(random);
  const MotionFrame once = mirrored(frame, header.camera);
  EXPECT_EQ((*once.hands)[0].angles, (*frame.hands)[1].angles);
  EXPECT_EQ((*once.face)[Expression::eye_blink_left], (*frame.face)[Expression::eye_blink_right]);
  EXPECT_EQ(once.face->gaze.x(), -frame.face->gaze.x());
  const auto l_wrist = static_cast<std::size_t>(Joint::l_wrist);
  const auto r_wrist = static_cast<std::size_t>(Joint::r_wrist);
  EXPECT_DOUBLE_EQ(once.spread->covariance[l_wrist](0, 1), -frame.spread->covariance[r_wrist](0, 1));
  EXPECT_DOUBLE_EQ(once.spread->covariance[l_wrist](1, 2), frame.spread->covariance[r_wrist](1, 2));
  const MotionFrame twice = mirrored(once, header.camera);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    EXPECT_EQ(twice.joints.at[j], frame.joints.at[j]);
    EXPECT_LT((twice.pixels[j] - frame.pixels[j]).norm(), 1e-9);
    EXPECT_EQ(twice.spread->covariance[j], frame.spread->covariance[j]);
  }
  EXPECT_EQ((*twice.hands)[0].angles, (*frame.hands)[0].angles);
  EXPECT_EQ(twice.face->expressions, frame.face->expressions);
}

}  // namespace
}  // namespace telemime
