// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/sdf.h"

#include <gtest/gtest.h>

#include "telemime/core/random.h"

namespace telemime {
namespace {

using Eigen::Vector3f;

Vector3f random_point(Random& random, double reach) {
  const auto draw = [&] { return static_cast<float>(random.uniform(-reach, reach)); };
  return Vector3f{draw(), draw(), draw()};
}

// Distance to the hull of two balls by brute force over the balls between them.
float round_cone_by_balls(const Vector3f& a, const Vector3f& b, float ra, float rb, const Vector3f& p) {
  float d = 1e9f;
  for (int i = 0; i <= 20000; ++i) {
    const float t = static_cast<float>(i) / 20000.0f;
    d = std::min(d, (p - (a + t * (b - a))).norm() - (ra + t * (rb - ra)));
  }
  return d;
}

TEST(RoundCone, IsTheHullOfItsBalls) {
  Random random(3);
  for (int i = 0; i < 40; ++i) {
    const Vector3f a = random_point(random, 1.0);
    const Vector3f b = random_point(random, 1.0);
    const auto ra = static_cast<float>(random.uniform(0.02, 0.3));
    const auto rb = static_cast<float>(random.uniform(0.02, 0.3));
    if ((a - b).norm() < 1.2f * std::abs(ra - rb)) {
      continue;
    }
    const RoundCone cone = round_cone(a, b, ra, rb);
    const Vector3f p = random_point(random, 2.0);
    const float expected = round_cone_by_balls(a, b, ra, rb, p);
    if (expected > 0.0f) {
      EXPECT_NEAR(distance(cone, p), expected, 2e-4f) << "case " << i;
    }
  }
}

TEST(RoundCone, OneBallInsideTheOtherStaysFinite) {
  const RoundCone cone = round_cone({0, 0, 0}, {0, 0, 0}, 0.2f, 0.1f);
  EXPECT_NEAR(distance(cone, {1.0f, 0.0f, 0.0f}), 0.8f, 2e-3f);
  EXPECT_GT(cone.slant2, 0.0f);
}

TEST(Ellipsoid, ZeroOnTheSurfaceAndASphereIsExact) {
  EXPECT_NEAR(ellipsoid({0.3f, 0.0f, 0.0f}, {0.3f, 0.2f, 0.1f}), 0.0f, 1e-6f);
  EXPECT_NEAR(ellipsoid({0.0f, -0.2f, 0.0f}, {0.3f, 0.2f, 0.1f}), 0.0f, 1e-6f);
  EXPECT_NEAR(ellipsoid({0.6f, 0.8f, 0.0f}, {0.25f, 0.25f, 0.25f}), 0.75f, 1e-6f);
  EXPECT_LT(ellipsoid({0.0f, 0.0f, 0.0f}, {0.3f, 0.2f, 0.1f}), 0.0f);
}

TEST(SmoothUnion, BoundedNearbyAndPlainFarAway) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const auto a = static_cast<float>(random.uniform(-1.0, 1.0));
    const auto b = static_cast<float>(random.uniform(-1.0, 1.0));
    const float k = 0.2f;
    const float d = smooth_union(a, b, k);
    EXPECT_LE(d, std::min(a, b));
    EXPECT_GE(d, std::min(a, b) - 0.25f * k - 1e-6f);
    EXPECT_EQ(d, smooth_union(b, a, k));
    if (std::abs(a - b) > k) {
      EXPECT_EQ(d, std::min(a, b));
    }
    EXPECT_EQ(smooth_intersection(a, b, k), -smooth_union(-a, -b, k));
  }
}

TEST(ValueNoise, InRangeContinuousAndSeeded) {
  Random random(7);
  float lowest = 1.0f;
  float highest = -1.0f;
  int different = 0;
  for (int i = 0; i < 500; ++i) {
    const Vector3f p = random_point(random, 50.0);
    const float here = value_noise(p, 1);
    lowest = std::min(lowest, here);
    highest = std::max(highest, here);
    EXPECT_NEAR(here, value_noise(p + Vector3f(1e-3f, 0.0f, 0.0f), 1), 6e-3f);
    different += std::abs(here - value_noise(p, 2)) > 0.05f ? 1 : 0;
  }
  EXPECT_GE(lowest, -1.0f);
  EXPECT_LE(highest, 1.0f);
  EXPECT_LT(lowest, -0.4f);
  EXPECT_GT(highest, 0.4f);
  EXPECT_GT(different, 300);
}

}  // namespace
}  // namespace telemime
