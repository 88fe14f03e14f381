// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/hand_model.h"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>

#include "telemime/body/hand_motion.h"
#include "telemime/body/rotations.h"
#include "telemime/core/random.h"

namespace telemime {
namespace {

HandAngles random_angles(Random& random) {
  HandAngles angles{};
  for (std::size_t a = 0; a < kHandAngleCount; ++a) {
    angles[a] = random.uniform(hand_limits()[a].min, hand_limits()[a].max);
  }
  return angles;
}

Eigen::Isometry3d random_place(Random& random) {
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.linear() = compose_zxy({random.uniform(-3, 3), random.uniform(-1.5, 1.5), random.uniform(-3, 3)});
  place.translation() = Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.3, 2));
  return place;
}

TEST(HandModel, PalmIsTurnedAsItsPointsAre) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    for (const Side side : {Side::left, Side::right}) {
      const HandSizes sizes = average_hand(random.uniform(1.5, 2.0));
      const Eigen::Isometry3d place = random_place(random);
      HandPoints points = hand_points(sizes, random_angles(random), side, place);
      const double unit = random.uniform(0.1, 1000.0);
      for (Eigen::Vector3d& p : points) {
        p *= unit;
      }
      const auto turn = palm_rotation(sizes, points, side);
      ASSERT_TRUE(turn);
      EXPECT_LT((*turn - place.linear()).norm(), 1e-6);
    }
  }
}

TEST(HandModel, NoisyPointsTurnThePalmLittle) {
  Random random(2);
  double sum = 0.0;
  constexpr int kTurns = 100;
  for (int i = 0; i < kTurns; ++i) {
    const HandSizes sizes = average_hand(1.72);
    const Eigen::Isometry3d place = random_place(random);
    HandPoints points = hand_points(sizes, random_angles(random), Side::right, place);
    for (Eigen::Vector3d& p : points) {
      p += 0.004 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    }
    const auto turn = palm_rotation(sizes, points, Side::right);
    ASSERT_TRUE(turn);
    sum += Eigen::Quaterniond(*turn).angularDistance(Eigen::Quaterniond(Eigen::Matrix3d(place.linear())));
  }
  EXPECT_LT(sum / kTurns, 0.13) << "rad; 4 mm in a palm some 40 mm wide";
}

TEST(HandModel, AnyGarbageTurnsThePalmSomehow) {
  Random random(3);
  int turned = 0;
  for (int i = 0; i < 500; ++i) {
    HandPoints points;
    const double size = std::pow(10.0, random.uniform(-6, 5));
    for (Eigen::Vector3d& p : points) {
      p = size * Eigen::Vector3d(random.normal(), random.normal(), i % 3 == 0 ? 0.0 : random.normal());
      p = i % 5 == 0 ? Eigen::Vector3d(size, size * (p.x() > 0.0), 0.0) : p;
    }
    for (const Side side : {Side::left, Side::right}) {
      const auto turn = palm_rotation(average_hand(1.72), points, side);
      turned += turn ? 1 : 0;
      EXPECT_TRUE(!turn || (*turn * turn->transpose() - Eigen::Matrix3d::Identity()).norm() < 1e-9);
    }
  }
  EXPECT_GT(turned, 900);
  HandPoints points;
  points.fill(Eigen::Vector3d::Zero());
  EXPECT_FALSE(palm_rotation(average_hand(1.72), points, Side::left)) << "a point";
  points[7].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(palm_rotation(average_hand(1.72), points, Side::left));
}

TEST(HandModel, RightHandMirrorsLeftHand) {
  Random random(4);
  const HandAngles angles = random_angles(random);
  const HandSizes sizes = average_hand(1.72);
  const HandPoints left = hand_points(sizes, angles, Side::left, Eigen::Isometry3d::Identity());
  HandPoints right = hand_points(sizes, angles, Side::right, Eigen::Isometry3d::Identity());
  for (std::size_t j = 0; j < kHandJointCount; ++j) {
    EXPECT_LT((left[j] - Eigen::Vector3d(-right[j].x(), right[j].y(), right[j].z())).norm(), 1e-12);
    right[j].x() += 1e-3 * random.normal();
  }
  HandPoints mirror = right;
  for (Eigen::Vector3d& p : mirror) {
    p.x() = -p.x();
  }
  const Eigen::DiagonalMatrix<double, 3> flip(-1.0, 1.0, 1.0);
  EXPECT_EQ(*palm_rotation(sizes, right, Side::right),
            flip * *palm_rotation(sizes, mirror, Side::left) * flip);
}

TEST(HandModel, FingersBendTowardThePalm) {
  const HandSizes sizes = average_hand(1.72);
  HandAngles fist{};
  for (std::size_t a = 4; a < kHandAngleCount; ++a) {
    fist[a] = (a - 4) % 3 == 1 ? 0.0 : std::numbers::pi / 2.0;
  }
  const HandPoints flat = hand_points(sizes, {}, Side::left, Eigen::Isometry3d::Identity());
  const HandPoints bent = hand_points(sizes, fist, Side::left, Eigen::Isometry3d::Identity());
  EXPECT_NEAR(flat[12].x(), 0.0, 1e-12);
  EXPECT_LT(flat[12].y(), -0.15) << "a flat hand is longer than 15 cm";
  EXPECT_GT(flat[4].z(), 0.05) << "the thumb is on the side of +z";
  EXPECT_LT(bent[10].x(), -0.03) << "the palm faces -x";
  EXPECT_GT(bent[12].y(), bent[10].y()) << "the tip points back to the wrist";
}

TEST(HandModel, WristAnglesAreThoseOfTheRotation) {
  Random random(6);
  for (int i = 0; i < 100; ++i) {
    const WristAngles angles{random.uniform(-1.7, 1.7), random.uniform(-0.7, 0.6), random.uniform(-1.4, 1.4)};
    const WristAngles found = wrist_angles(wrist_rotation(angles));
    EXPECT_NEAR(found.twisting, angles.twisting, 1e-9);
    EXPECT_NEAR(found.pivot, angles.pivot, 1e-9);
    EXPECT_NEAR(found.flexion, angles.flexion, 1e-9);
  }
}

TEST(HandMotion, HandIsAtTheWristAsItWasSeen) {
  const Body body = make_body(Shape{});
  Pose pose;
  pose[Angle::l_elbow_flexion] = -1.5;
  pose[Angle::r_elbow_flexion] = -1.0;
  const Kinematics k = forward_kinematics(body, pose);
  HandMotions hands;
  const Eigen::Matrix3d turned = k[Segment::l_forearm].linear() * wrist_rotation({0.9, -0.1, 0.5});
  hands[0].seen = Eigen::Quaterniond(turned);
  place_hands(k, hands);
  EXPECT_LT((hands[0].joints[0] - k.joints[Joint::l_wrist]).norm(), 1e-12);
  EXPECT_NEAR(hands[0].wrist.twisting, 0.9, 1e-9);
  EXPECT_NEAR(hands[1].wrist.twisting, 0.0, 1e-9) << "one that is not seen is that of the body";
  const Kinematics with = forward_kinematics(body, with_wrists(pose, hands));
  EXPECT_LT((with[Segment::l_hand].linear() - turned).norm(), 1e-9);
  // The mirror image of the hands is that of the mirrored body.
  HandMotions mirror = mirrored(hands);
  const HandMotions moved = mirror;
  place_hands(forward_kinematics(body, mirrored(pose)), mirror);
  for (std::size_t side = 0; side < 2; ++side) {
    EXPECT_NEAR(mirror[side].wrist.twisting, moved[side].wrist.twisting, 1e-9);
    for (std::size_t j = 0; j < kHandJointCount; ++j) {
      EXPECT_LT((mirror[side].joints[j] - moved[side].joints[j]).norm(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace telemime
