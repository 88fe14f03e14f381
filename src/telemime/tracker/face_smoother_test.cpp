// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/face_smoother.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

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

// Two looks at a face of which a coefficient is `value`, each with this much noise.
FaceMotion looks(Expression e, double value, double deviation, Random& random) {
  const double a = value + random.normal(0.0, deviation), b = value + random.normal(0.0, deviation);
  FaceMotion face = seen_face();
  face[e] = std::clamp(0.5 * (a + b), 0.0, 1.0);
  face.noise.expressions[static_cast<std::size_t>(e)] = std::abs(a - b);
  return face;
}
constexpr double kClear = 0.018;  // makes two looks differ by 0.025, as at a face near a webcam
constexpr double kHidden = 0.1;   // and as at a mouth behind a mask

TEST(FaceSmoother, NoiseThatTwoLooksShowIsRemoved) {
  FaceSmoother smoother;
  Random random(1);
  double sum = 0.0, squares = 0.0;
  constexpr int kFrames = 300;
  for (int t = 0; t < 25 + kFrames; ++t) {
    const double now =
        (*smoother(looks(mouth_smile_left, 0.5, kHidden, random), kStep * t))[mouth_smile_left];
    if (t >= 25) {
      sum += now / kFrames;
      squares += now * now / kFrames;
    }
  }
  EXPECT_LT(std::sqrt(squares - sum * sum), 0.05);
  EXPECT_NEAR(sum, 0.5, 0.1) << "drawn to rest a little";
}

TEST(FaceSmoother, ClearBlinksAndLipsKeepTheirMotion) {
  for (const double rate : {17.0, 25.0, 30.0}) {
    FaceSmoother smoother, before;
    Random random(1);
    for (int t = 0; t < 200; ++t) {
      // The jaw of somebody who talks, 4 syllables a second, and a blink of 0.15 s each second.
      const double time = t / rate;
      const double jaw = 0.25 - 0.25 * std::cos(8.0 * std::numbers::pi * time);
      const double in_blink = std::fmod(time, 1.0) / 0.15;
      const double lid = in_blink < 1.0 ? std::sin(std::numbers::pi * in_blink) : 0.0;
      FaceMotion face = looks(jaw_open, jaw, kClear, random);
      const FaceMotion eyes = looks(eye_blink_left, lid, kClear, random);
      face[eye_blink_left] = eyes[eye_blink_left];
      face.noise.expressions[static_cast<std::size_t>(eye_blink_left)] =
          eyes.noise.expressions[static_cast<std::size_t>(eye_blink_left)];
      FaceMotion without = face;
      without.noise = {};
      const auto now = smoother(face, time);
      const auto then = before(without, time);
      if (t > 25) {
        EXPECT_NEAR((*now)[jaw_open], (*then)[jaw_open], 0.1) << rate << ' ' << t;
        EXPECT_NEAR((*now)[eye_blink_left], (*then)[eye_blink_left], 0.1) << rate << ' ' << t;
      }
    }
  }
}

TEST(FaceSmoother, FirstFrameThatIsBadlySeenDoesNotStiffenAFile) {
  // The jaw of somebody who talks, smoothed forward and then backward, as files are.
  constexpr int kFrames = 100;
  const auto range_of = [](double noise_at_first) {
    FaceSmoother forward, backward;
    std::vector<FaceMotion> face;
    for (int t = 0; t < kFrames; ++t) {
      FaceMotion seen = seen_face();
      seen[jaw_open] = 0.25 - 0.25 * std::cos(4.0 * std::numbers::pi * kStep * t);
      seen.noise.expressions[static_cast<std::size_t>(jaw_open)] = t == 0 ? noise_at_first : kClear;
      face.push_back(*forward(seen, kStep * t));
    }
    double least = 1.0, most = 0.0;
    for (int t = kFrames; t-- > 0;) {
      const double jaw = (*backward(face[static_cast<std::size_t>(t)], -kStep * t))[jaw_open];
      least = t < kFrames / 2 ? std::min(least, jaw) : least;
      most = t < kFrames / 2 ? std::max(most, jaw) : most;
    }
    return most - least;
  };
  EXPECT_GT(range_of(0.0), 0.4);
  EXPECT_GT(range_of(0.1), 0.9 * range_of(0.0));
}

TEST(FaceSmoother, UncoveredMouthMovesSoon) {
  FaceSmoother smoother;
  Random random(1);
  int t = 0;
  for (; t < 50; ++t) {
    smoother(looks(jaw_open, 0.0, kHidden, random), kStep * t);
  }
  for (; t < 65; ++t) {
    smoother(looks(jaw_open, 0.6, kClear, random), kStep * t);
  }
  EXPECT_GT((*smoother(looks(jaw_open, 0.6, kClear, random), kStep * t))[jaw_open], 0.5);
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
