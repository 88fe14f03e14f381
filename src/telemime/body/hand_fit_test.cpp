// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/hand_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "telemime/core/random.h"

namespace telemime {
namespace {

const HandSizes kSizes = average_hand(1.72);

// Fingers that move together about rest, each a little by itself.
HandAngles some_angles(Random& random) {
  HandAngles angles = resting_hand();
  const double together = random.uniform(-0.3, 0.7);
  for (std::size_t a = 0; a < kHandAngleCount; ++a) {
    const bool spread = a == 1 || (a >= 4 && (a - 4) % 3 == 1);
    angles[a] += spread ? 0.08 * random.normal() : together + 0.15 * random.normal();
    angles[a] = std::clamp(angles[a], hand_limits()[a].min, hand_limits()[a].max);
  }
  return angles;
}

Eigen::Isometry3d some_turn(Random& random) {
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.linear() = Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal())
                       .normalized()
                       .toRotationMatrix();
  return place;
}

// Mean distance of two hands' joints in the frame of the palm, m.
double difference(const HandAngles& a, const HandAngles& b, Side side) {
  const HandPoints p = hand_points(kSizes, a, side, Eigen::Isometry3d::Identity());
  const HandPoints q = hand_points(kSizes, b, side, Eigen::Isometry3d::Identity());
  double sum = 0.0;
  for (std::size_t i = 0; i < kHandJointCount; ++i) {
    sum += (p[i] - q[i]).norm() / kHandJointCount;
  }
  return sum;
}

TEST(HandFit, ExactPointsGiveNearlyTheirHand) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    for (const Side side : {Side::left, Side::right}) {
      const HandAngles angles = some_angles(random);
      const auto hand = likeliest_hand(kSizes, hand_points(kSizes, angles, side, some_turn(random)), side);
      ASSERT_TRUE(hand);
      EXPECT_LT(difference(hand->angles, angles, side), 0.012);
      EXPECT_LT(hand->error, 0.006);
      EXPECT_NEAR(hand->scale, 1.0, 0.1);
    }
  }
}

TEST(HandFit, TiltedAndNoisyDepthsMatterLittle) {
  Random random(2);
  double rest = 0.0;
  double likely = 0.0;
  constexpr int kHands = 100;
  for (int i = 0; i < kHands; ++i) {
    const HandAngles angles = some_angles(random);
    HandPoints points = hand_points(kSizes, angles, Side::left, some_turn(random));
    const Eigen::Vector2d tilt(0.4 * random.normal(), 0.4 * random.normal());
    for (Eigen::Vector3d& p : points) {
      p.z() += tilt.dot(p.head<2>()) + 0.012 * random.normal();
      p.head<2>() += 0.004 * Eigen::Vector2d(random.normal(), random.normal());
    }
    rest += difference(resting_hand(), angles, Side::left) / kHands;
    likely += difference(likeliest_hand(kSizes, points, Side::left)->angles, angles, Side::left) / kHands;
  }
  EXPECT_LT(likely, 0.4 * rest);
  EXPECT_LT(likely, 0.012);
}

TEST(HandFit, RightHandMirrorsLeftHand) {
  Random random(3);
  const HandAngles angles = some_angles(random);
  HandPoints points = hand_points(kSizes, angles, Side::left, some_turn(random));
  for (Eigen::Vector3d& p : points) {
    p += 0.004 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  }
  const auto left = likeliest_hand(kSizes, points, Side::left);
  for (Eigen::Vector3d& p : points) {
    p.x() = -p.x();
  }
  const auto right = likeliest_hand(kSizes, points, Side::right);
  ASSERT_TRUE(left && right);
  EXPECT_NEAR(left->cost, right->cost, 1e-2 * left->cost);
  EXPECT_LT(difference(left->angles, right->angles, Side::left), 1e-3);
}

TEST(HandFit, GarbageGivesAnglesWithinLimits) {
  Random random(4);
  int fitted = 0;
  for (int i = 0; i < 200; ++i) {
    const double size = std::pow(10.0, random.uniform(-6, 5));
    HandPoints points;
    for (Eigen::Vector3d& p : points) {
      p = size * Eigen::Vector3d(random.normal(), random.normal(), i % 3 == 0 ? 0.0 : random.normal());
      p = i % 5 == 0 ? Eigen::Vector3d(size, size * (p.x() > 0.0), 0.0) : p;
    }
    const auto hand = likeliest_hand(kSizes, points, i % 2 == 0 ? Side::left : Side::right);
    if (!hand) {
      continue;
    }
    ++fitted;
    for (std::size_t a = 0; a < kHandAngleCount; ++a) {
      EXPECT_GE(hand->angles[a], hand_limits()[a].min);
      EXPECT_LE(hand->angles[a], hand_limits()[a].max);
    }
    EXPECT_TRUE(hand->frame_from_hand.allFinite() && std::isfinite(hand->error) && hand->scale > 0.0);
  }
  EXPECT_GT(fitted, 180);
  HandPoints points = points_at_origin();
  EXPECT_FALSE(likeliest_hand(kSizes, points, Side::left)) << "a point";
  points[7].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(likeliest_hand(kSizes, points, Side::left));
}

}  // namespace
}  // namespace telemime
