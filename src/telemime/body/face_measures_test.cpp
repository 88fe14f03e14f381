// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/face_measures.h"

#include <gtest/gtest.h>

#include <numbers>

#include "telemime/body/face_expression.h"
#include "telemime/body/testing_face.h"

namespace telemime {
namespace {

using testing::TestFace;
using enum Expression;

class FaceAtRest : public ::testing::Test {
 protected:
  /// A face whose head is turned by an angle in degrees, `scale` pixels per mm.
  FaceMotion see(const TestFace& face, double time, double yaw = 0.0, double scale = 2.0) {
    const Camera camera{.width = 640, .height = 480, .fx = 600, .fy = 600, .cx = 320, .cy = 240};
    const Eigen::Quaterniond turn(
        Eigen::AngleAxisd(yaw * std::numbers::pi / 180.0, Eigen::Vector3d::UnitY()));
    return face_motion(face.seen(turn, scale, {320, 240}), 1.0, camera, time, neutral_);
  }

 private:
  NeutralFace neutral_;
};

TEST_F(FaceAtRest, PersonsOwnFaceIsLearned) {
  // Somebody whose eyes are narrower, brows higher and mouth wider than those of the canonical face.
  TestFace own;
  own.close_eye(Side::left, 0.25);
  own.close_eye(Side::right, 0.25);
  own.brow_inner(Side::left, 4);
  own.brow_inner(Side::right, 4);
  own.move(own.corner(Side::left), {5, 0, 0});
  own.move(own.corner(Side::right), {-5, 0, 0});
  FaceMotion face;
  for (int i = 0; i < 100; ++i) {
    TestFace now = own;
    if (i % 10 == 0) {  // blinks do not matter
      now.close_eye(Side::left, 0.9);
      now.close_eye(Side::right, 0.9);
    }
    face = see(now, 0.04 * i);
  }
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    EXPECT_LT(face.expressions[i], 0.05) << kExpressionNames[i];
  }
  own.close_eye(Side::left, 0.9);
  face = see(own, 4.0);
  EXPECT_GT(face[eye_blink_left], 0.8);
  EXPECT_LT(face[eye_blink_right], 0.2);
}

TEST_F(FaceAtRest, LastingGrimaceDoesNotBecomeTheFaceAtRest) {
  TestFace grimace;
  grimace.jaw({0, 30, 0});
  grimace.close_eye(Side::left, 0.95);
  FaceMotion face;
  for (int i = 0; i < 500; ++i) {
    face = see(grimace, 0.2 * i);
  }
  EXPECT_GT(face[jaw_open], 0.4);
  EXPECT_GT(face[eye_blink_left], 0.5);
}

TEST_F(FaceAtRest, SmallFaceIsNotLearned) {
  TestFace wrong;
  wrong.jaw({0, 12, 0});
  wrong.close_eye(Side::left, 0.2);
  wrong.brow_outer(Side::left, 7);
  for (int i = 0; i < 50; ++i) {  // pupils 19 pixels apart
    see(wrong, 0.1 * i, 0.0, 0.3);
  }
  const FaceMotion face = see(TestFace(), 5.0, 0.0, 2.0);
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    EXPECT_NEAR(face.expressions[i], 0.0, 1e-6) << kExpressionNames[i];
  }
}

TEST_F(FaceAtRest, WhatOnlyTheSideShowsIsItsRest) {
  TestFace odd;
  odd.brow_outer(Side::left, 5);
  odd.move(odd.corner(Side::left), {0, 4, 0});
  for (int i = 0; i < 50; ++i) {
    see(TestFace(), 0.1 * i, 0.0);
  }
  EXPECT_GT(see(odd, 5.0, 40.0)[brow_outer_up_left], 0.5) << "at first it is taken for an expression";
  for (int i = 1; i < 80; ++i) {
    see(odd, 5.0 + 0.1 * i, 40.0);
  }
  const FaceMotion side = see(odd, 13.0, 40.0);
  EXPECT_LT(side[brow_outer_up_left], 0.05);
  EXPECT_LT(side[mouth_frown_left], 0.05);
  const FaceMotion front = see(TestFace(), 13.1, 0.0);
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    EXPECT_NEAR(front.expressions[i], 0.0, 1e-6) << kExpressionNames[i];
  }
  EXPECT_GT(see(odd, 13.2, 0.0)[brow_outer_up_left], 0.5);
}

}  // namespace
}  // namespace telemime
