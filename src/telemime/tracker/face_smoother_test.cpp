// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/face_smoother.h"

#include <gtest/gtest.h>

#include <cmath>

#include "telemime/core/random.h"

namespace telemime {
namespace {

using enum Expression;
constexpr double kStep = 0.04;  // s

FaceMotion seen_face() {
  FaceMotion face;
  face.confidence = 1.0;
  return face;
}

TEST(FaceSmoother, BlinksAreFollowedAtOnceAndBrowsSteadily) {
  FaceSmoother smoother;
  FaceMotion face = seen_face();
  for (int t = 0; t < 10; ++t) {
    smoother(face, kStep * t);
  }
  face[eye_blink_left] = 1.0;
  face[brow_inner_up] = 1.0;
  const auto closed = smoother(face, kStep * 10);
  EXPECT_GT((*closed)[eye_blink_left], 0.7);
  EXPECT_LT((*closed)[brow_inner_up], 0.6);
  for (int t = 11; t < 60; ++t) {
    smoother(face, kStep * t);
  }
  EXPECT_NEAR((*smoother(face, kStep * 60))[brow_inner_up], 1.0, 1e-3);
}

TEST(FaceSmoother, NoiseOfBrowsAndHeadIsRemoved) {
  FaceSmoother smoother;
  Random random(1);
  double raw = 0.0, smooth = 0.0, head = 0.0;
  for (int t = 0; t < 300; ++t) {
    FaceMotion face = seen_face();
    face[brow_inner_up] = 0.5 + random.normal(0.0, 0.05);
    face.head = Eigen::AngleAxisd(random.normal(0.0, 0.02), Eigen::Vector3d::UnitY());
    const auto result = smoother(face, kStep * t);
    if (t > 50) {
      raw += std::abs(face[brow_inner_up] - 0.5);
      smooth += std::abs((*result)[brow_inner_up] - 0.5);
      head += result->head.angularDistance(Eigen::Quaterniond::Identity());
    }
  }
  EXPECT_LT(smooth, 0.6 * raw);
  EXPECT_LT(head / 249, 0.01);
}

TEST(FaceSmoother, UnseenFaceGoesToRestGently) {
  FaceSmoother smoother;
  FaceMotion face = seen_face();
  face[jaw_open] = 0.8;
  face.gaze = {0.3, 0.1};
  for (int t = 0; t < 25; ++t) {
    smoother(face, kStep * t);
  }
  double last = 0.8;
  int frames = 0;
  for (int t = 25; t < 100; ++t) {
    const auto result = smoother(std::nullopt, kStep * t);
    if (!result) {
      break;
    }
    ++frames;
    EXPECT_LE((*result)[jaw_open], last);
    EXPECT_GT((*result)[jaw_open], 0.7 * last) << "no jump";
    last = (*result)[jaw_open];
  }
  EXPECT_LT(last, 0.05);
  EXPECT_GT(frames, 10);
  EXPECT_LT(frames, 50);
}

TEST(FaceSmoother, FaceThatComesAndGoesDoesNotFlutter) {
  FaceSmoother smoother;
  FaceMotion face = seen_face();
  face[jaw_open] = 0.8;
  double last = 0.0;
  for (int t = 0; t < 100; ++t) {
    const auto result = smoother(t % 2 == 0 ? std::optional(face) : std::nullopt, kStep * t);
    ASSERT_TRUE(result);
    if (t > 20) {
      EXPECT_LT(std::abs((*result)[jaw_open] - last), 0.3);
      EXPECT_NEAR(result->confidence, 0.5, 0.2);
    }
    last = (*result)[jaw_open];
  }
}

TEST(FaceSmoother, FaceWithoutConfidenceIsNone) {
  FaceSmoother smoother;
  for (int t = 0; t < 5; ++t) {
    EXPECT_FALSE(smoother(FaceMotion{}, kStep * t)) << t;
  }
  FaceMotion face = seen_face();
  face[jaw_open] = 0.8;
  smoother(face, kStep * 5);
  EXPECT_LT((*smoother(FaceMotion{}, kStep * 6))[jaw_open], 0.8) << "goes to rest";
}

TEST(FaceSmoother, HeadThatComesBackDoesNotJump) {
  FaceSmoother smoother;
  constexpr double kTurn = 0.52;  // rad
  FaceMotion face = seen_face();
  for (int t = 0; t < 25; ++t) {
    smoother(face, kStep * t);
  }
  for (int t = 25; t < 37; ++t) {
    ASSERT_TRUE(smoother(std::nullopt, kStep * t));
  }
  face.head = Eigen::AngleAxisd(kTurn, Eigen::Vector3d::UnitY());
  const auto back = smoother(face, kStep * 37);
  EXPECT_LT(back->head.angularDistance(Eigen::Quaterniond::Identity()), 0.3 * kTurn);
  for (int t = 38; t < 62; ++t) {
    smoother(face, kStep * t);
  }
  EXPECT_LT(smoother(face, kStep * 62)->head.angularDistance(face.head), 0.05 * kTurn);
}

TEST(FaceSmoother, PauseBeginsANewMotion) {
  FaceSmoother smoother;
  FaceMotion face = seen_face();
  smoother(face, 0.0);
  face[jaw_open] = 1.0;
  EXPECT_EQ((*smoother(face, 5.0))[jaw_open], 1.0);
  EXPECT_FALSE(smoother(std::nullopt, 10.0));
}

}  // namespace
}  // namespace telemime
