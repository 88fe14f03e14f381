// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/hands.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "telemime/body/arm_parts.h"
#include "telemime/body/rotations.h"
#include "telemime/core/random.h"
#include "telemime/tracker/hand_smoother.h"

namespace telemime {
namespace {

// A person with both hands before the chest, and what a perfect network sees of them.
class Hands : public ::testing::Test {
 protected:
  Hands() {
    pose_.root = {0.0, 0.4, 1.4};
    for (const Angle elbow : {Angle::l_elbow_flexion, Angle::r_elbow_flexion}) {
      pose_[elbow] = -2.0;
    }
    kinematics_ = forward_kinematics(body_, pose_);
  }

  HandScene scene(double time) const { return {body_, kinematics_, camera_, time}; }

  static HandAngles some_angles(double bend) {
    HandAngles angles = resting_hand();
    for (std::size_t a = 4; a < kHandAngleCount; ++a) {
      angles[a] += (a - 4) % 3 == 1 ? 0.0 : bend;
    }
    return angles;
  }

  // At its arm, or `offset` away from it.
  SeenHand seen(Side side, const HandAngles& angles,
                const Eigen::Vector3d& offset = Eigen::Vector3d::Zero()) const {
    Eigen::Isometry3d place = kinematics_[arm_parts(side).hand];
    place.pretranslate(offset);
    const HandPoints points = hand_points(average_hand(body_.shape.stature), angles, side, place);
    HandLandmarks hand;
    hand.presence = 0.95;
    hand.is_right = side == Side::right ? 0.95 : 0.05;
    hand.region = {.centre = camera_.project(points[9]), .width = 60.0, .height = 60.0};
    const Eigen::Matrix3d upright = rotation_between(points[0], Eigen::Vector3d::UnitZ()).toRotationMatrix();
    for (std::size_t i = 0; i < kHandJointCount; ++i) {
      hand.points[i] = {.pixel = camera_.project(points[i]), .world = upright * (points[i] - points[9])};
    }
    return {.looked = true, .found = hand};
  }

  static double largest_difference(const HandAngles& a, const HandAngles& b) {
    double most = 0.0;
    for (std::size_t i = 0; i < kHandAngleCount; ++i) {
      most = std::max(most, std::abs(a[i] - b[i]));
    }
    return most;
  }

  // The largest change of an angle between two frames in which a hand that is seen with this visibility has
  // this much noise in each angle, rad.
  double largest_step(double visibility, double noise) const {
    Random random(1);
    HandSmoother smoother({.one_euro = {1.5, 1.5, 1.0}, .share = {}});
    HandMotions hands;
    double largest = 0.0;
    for (int t = 0; t < 300; ++t) {
      HandMotions measured;
      for (HandMotion& hand : measured) {
        hand.visibility = visibility;
        hand.seen = Eigen::Quaterniond::Identity();
        for (double& angle : hand.angles) {
          angle += random.normal(0.0, noise);
        }
      }
      const HandMotions now = smoother(measured, kinematics_, 0.04);
      for (std::size_t side = 0; side < 2 && t > 10; ++side) {
        largest = std::max(largest, largest_difference(now[side].angles, hands[side].angles));
      }
      hands = now;
    }
    return largest;
  }

  Body body_ = make_body(Shape{});
  Pose pose_;
  Kinematics kinematics_;
  Camera camera_;
};

TEST_F(Hands, SeenHandsHaveTheAnglesOfThePoints) {
  HandState state;
  const HandAngles angles = some_angles(0.6);
  const HandMotions hands =
      observe_hands({seen(Side::left, angles), seen(Side::right, angles)}, scene(0.0), state);
  for (const HandMotion& hand : hands) {
    EXPECT_GT(hand.visibility, 0.8);
    EXPECT_LT(largest_difference(hand.angles, angles), 0.2) << "drawn to rest a little";
    EXPECT_LT(hand.spread, 0.02);
  }
  EXPECT_LT((hands[0].joints[0] - kinematics_.joints[Joint::l_wrist]).norm(), 1e-12);
}

TEST_F(Hands, PalmTakenForABackIsMirrored) {
  const HandAngles angles = some_angles(0.6);
  SeenHand left = seen(Side::left, angles);
  left.found->is_right = 0.9;
  for (HandLandmark& p : left.found->points) {
    p.world.z() = -p.world.z();
  }
  HandState state;
  const HandMotions hands = observe_hands({left, SeenHand{}}, scene(0.0), state);
  EXPECT_GT(hands[0].visibility, 0.8);
  EXPECT_LT(largest_difference(hands[0].angles, angles), 0.25);
}

TEST_F(Hands, CrossedHandsKeepTheirSides) {
  HandState state;
  const SeenHand left = seen(Side::left, some_angles(0.8));
  const SeenHand right = seen(Side::right, resting_hand());
  for (int t = 0; t < 10; ++t) {
    // Found in turn where the other was looked for, and taken for the other.
    std::array<SeenHand, 2> found = {left, right};
    if (t % 2 == 1) {
      std::swap(found[0], found[1]);
    }
    const HandMotions hands = observe_hands(found, scene(0.04 * t), state);
    EXPECT_GT(hands[0].angles[6], hands[1].angles[6] + 0.4);
  }
}

TEST_F(Hands, HandBelongsToTheNearestArm) {
  const SeenHand left = seen(Side::left, resting_hand());
  const SeenHand right = seen(Side::right, resting_hand());
  for (const auto& [a, b] : {std::pair(left, right), std::pair(right, left)}) {
    const std::array<SeenHand, 2> both = {a, b};
    const auto mine = hands_of_arms(both, scene(0.0));
    ASSERT_TRUE(mine[0] != nullptr && mine[1] != nullptr);
    EXPECT_EQ(mine[0]->points[0].pixel, left.found->points[0].pixel);
    EXPECT_EQ(mine[1]->points[0].pixel, right.found->points[0].pixel);
  }
  // One hand, found where the other was looked for.
  const std::array<SeenHand, 2> exchanged = {right, SeenHand{.looked = true, .found = {}}};
  const auto one = hands_of_arms(exchanged, scene(0.0));
  EXPECT_EQ(one[0], nullptr);
  ASSERT_NE(one[1], nullptr);
}

TEST_F(Hands, HandOfSomebodyElseIsNoHand) {
  const std::array<SeenHand, 2> far = {seen(Side::left, resting_hand(), {0.5, -0.2, 0.0}), SeenHand{}};
  const auto mine = hands_of_arms(far, scene(0.0));
  EXPECT_EQ(mine[0], nullptr);
  EXPECT_EQ(mine[1], nullptr);
}

TEST_F(Hands, HandThatIsNotSeenIsHeldAndThenRests) {
  HandState state;
  const HandAngles angles = some_angles(0.8);
  observe_hands({seen(Side::left, angles), SeenHand{.looked = true, .found = {}}}, scene(0.0), state);
  EXPECT_GT(observe_hands({}, scene(0.04), state)[0].visibility, 0.8) << "the other hand's turn";
  EXPECT_GT(observe_hands({}, scene(0.3), state)[0].visibility, 0.8) << "the same, at few frames a second";
  const SeenHand missed{.looked = true, .found = {}};
  const HandMotions hands = observe_hands({missed, {}}, scene(0.3), state);
  EXPECT_EQ(hands[0].visibility, 0.0);
  EXPECT_EQ(hands[0].angles, resting_hand());
  observe_hands({seen(Side::left, angles), missed}, scene(0.4), state);
  EXPECT_EQ(observe_hands({}, scene(1.1), state)[0].visibility, 0.0) << "never looked for again";
}

TEST_F(Hands, PalmThatTurnsTooFastIsDoubted) {
  // Seen as the palm, then as the back, within a frame and within half a second.
  const HandAngles angles = some_angles(0.3);
  SeenHand turned = seen(Side::left, angles);
  const Eigen::Vector3d wrist = turned.found->points[0].world;
  const HandLandmarks as_it_is = *turned.found;
  for (std::size_t i = 0; i < kHandJointCount; ++i) {
    HandLandmark& p = turned.found->points[i];
    p.pixel.x() = 2.0 * as_it_is.points[0].pixel.x() - p.pixel.x();
    p.world.x() = 2.0 * wrist.x() - p.world.x();
    p.world.z() = 2.0 * wrist.z() - p.world.z();
  }
  const auto visibility = [&](double time) {
    HandState state;
    observe_hands({seen(Side::left, angles), SeenHand{}}, scene(0.0), state);
    return observe_hands({turned, SeenHand{}}, scene(time), state)[0].visibility;
  };
  EXPECT_LT(visibility(0.04), 0.5);
  EXPECT_GT(visibility(0.5), 0.8);
}

TEST_F(Hands, FingersThatBendTooFastAreDoubted) {
  const auto visibility = [&](double before, double time) {
    HandState state;
    observe_hands({seen(Side::left, some_angles(before)), SeenHand{}}, scene(0.0), state);
    return observe_hands({seen(Side::left, some_angles(0.6)), SeenHand{}}, scene(time), state)[0].visibility;
  };
  EXPECT_LT(visibility(-0.4, 0.04), 0.7);
  EXPECT_GT(visibility(-0.4, 0.2), 0.8);
  EXPECT_GT(visibility(0.2, 1.0 / 120.0), 0.8) << "noise, at a high frame rate";
}

TEST_F(Hands, SizesAreLearnedAndThenStay) {
  HandState state;
  const HandAngles angles = some_angles(0.3);
  const double average = average_hand(body_.shape.stature).palm;
  for (int t = 0; t < 400; ++t) {
    SeenHand hand = seen(Side::left, angles);
    for (HandLandmark& p : hand.found->points) {
      p.pixel = hand.found->points[0].pixel + 1.15 * (p.pixel - hand.found->points[0].pixel);
    }
    const HandSizes before = state.sizes.value_or(average_hand(body_.shape.stature));
    observe_hands({hand, SeenHand{}}, scene(0.04 * t), state);
    if (t > 300) {
      EXPECT_EQ(state.sizes->palm, before.palm);
    }
  }
  EXPECT_NEAR(state.sizes->palm / average, 1.15, 0.04);
}

TEST_F(Hands, GarbageMovesNothingWildly) {
  Random random(1);
  HandState state;
  HandSmoother smoother({.one_euro = {1.5, 1.5, 1.0}, .share = {}});
  HandMotions before;
  for (int t = 0; t < 200; ++t) {
    SeenHand hand = seen(Side::right, resting_hand());
    for (HandLandmark& p : hand.found->points) {
      p.pixel += 40.0 * Eigen::Vector2d(random.normal(), random.normal());
      p.world = 0.1 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    }
    if (t % 7 == 0) {
      hand.found->points[3].pixel.x() = std::nan("");
    }
    const HandMotions hands =
        smoother(observe_hands({SeenHand{}, hand}, scene(0.04 * t), state), kinematics_, 0.04);
    for (std::size_t side = 0; side < 2; ++side) {
      for (const Eigen::Vector3d& p : hands[side].joints) {
        ASSERT_TRUE(p.allFinite());
        EXPECT_LT((p - hands[side].joints[0]).norm(), 0.3);
      }
    }
    EXPECT_TRUE(t == 0 || largest_difference(hands[1].angles, before[1].angles) < 1.0);
    before = hands;
  }
}

TEST_F(Hands, SmoothedHandGoesToRestInHalfASecond) {
  constexpr double kStep = 0.04;
  HandState state;
  HandSmoother smoother({.one_euro = {1.5, 1.5, 1.0}, .share = {}});
  const HandAngles angles = some_angles(0.8);
  HandMotions hands;
  int t = 0;
  for (; t < 50; ++t) {
    hands = smoother(observe_hands({seen(Side::left, angles), SeenHand{}}, scene(kStep * t), state),
                     kinematics_, kStep);
  }
  EXPECT_GT(hands[0].visibility, 0.8);
  const double away = largest_difference(hands[0].angles, resting_hand());
  EXPECT_GT(away, 0.5);
  double before = away;
  for (int i = 0; i < 15; ++i, ++t) {
    const SeenHand missed{.looked = true, .found = {}};
    hands = smoother(observe_hands({missed, missed}, scene(kStep * t), state), kinematics_, kStep);
    const double now = largest_difference(hands[0].angles, resting_hand());
    EXPECT_LE(now, before + (i < 3 ? 0.01 : 1e-9)) << "held for a tenth of a second";
    EXPECT_LT(before - now, 0.3 * away) << "gently";
    before = now;
  }
  EXPECT_LT(before, 0.15 * away);
  EXPECT_LT(hands[0].visibility, 0.15);
}

TEST_F(Hands, HandThatAppearsDoesNotJump) {
  constexpr double kStep = 0.04;
  HandState state;
  HandSmoother smoother({.one_euro = {1.5, 1.5, 1.0}, .share = {}});
  HandMotions hands;
  for (int t = 0; t < 25; ++t) {
    hands = smoother(observe_hands({}, scene(kStep * t), state), kinematics_, kStep);
  }
  const HandAngles angles = some_angles(0.8);
  const double way = largest_difference(hands[0].angles, angles);
  for (int t = 25; t < 27; ++t) {
    const HandAngles before = hands[0].angles;
    hands = smoother(observe_hands({seen(Side::left, angles), SeenHand{}}, scene(kStep * t), state),
                     kinematics_, kStep);
    EXPECT_LT(largest_difference(hands[0].angles, before), 0.35 * way);
  }
  EXPECT_LT(largest_difference(hands[0].angles, angles), 0.7 * way) << "but it moves on";
}

TEST_F(Hands, BadlySeenFingersAreStill) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  EXPECT_LT(largest_step(0.6, 12.0 * kDegree), 5.0 * kDegree);
  // Jitter of a hand that claims to be clear, too.
  EXPECT_LT(largest_step(0.97, 8.0 * kDegree), 5.0 * kDegree);
}

TEST_F(Hands, ClearFingersAreFollowedAtOnce) {
  // A hand that closes within a fifth of a second.
  HandSmoother smoother({.one_euro = {1.5, 1.5, 1.0}, .share = {}});
  HandMotions measured;
  measured[0].visibility = 0.97;
  measured[0].seen = Eigen::Quaterniond::Identity();
  for (int t = 0; t < 25; ++t) {
    smoother(measured, kinematics_, 0.04);
  }
  const double open = measured[0].angles[7];
  double now = open;
  for (int t = 0; t < 8; ++t) {
    measured[0].angles[7] = open + 0.25 * std::min(t + 1, 5);
    now = smoother(measured, kinematics_, 0.04)[0].angles[7];
  }
  EXPECT_GT(now - open, 0.85 * 1.25) << "three frames later";
}

TEST_F(Hands, SmootherKeepsAHandThatIsStill) {
  HandSmoother smoother({.one_euro = {1.5, 1.5, 1.0}, .share = {}});
  HandState state;
  const HandMotions still = observe_hands(
      {seen(Side::left, some_angles(0.4)), seen(Side::right, some_angles(0.9))}, scene(0.0), state);
  for (int t = 0; t < 20; ++t) {
    const HandMotions smooth = smoother(still, kinematics_, 0.04);
    for (std::size_t side = 0; side < 2; ++side) {
      EXPECT_LT(largest_difference(smooth[side].angles, still[side].angles), 1e-9);
      EXPECT_LT((smooth[side].joints[8] - still[side].joints[8]).norm(), 1e-9);
    }
  }
}

}  // namespace
}  // namespace telemime
