// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/face_expression.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <numbers>
#include <set>

#include "telemime/body/testing_face.h"
#include "telemime/core/random.h"

namespace telemime {
namespace {

using testing::TestFace;
using enum Expression;

constexpr double kDeg = std::numbers::pi / 180.0;
const Camera kCamera{.width = 640, .height = 480, .fx = 600, .fy = 600, .cx = 320, .cy = 240};

FaceMotion motion_of(const TestFace& face, const Eigen::Quaterniond& turn = Eigen::Quaterniond::Identity()) {
  NeutralFace neutral;
  // The person is seen at rest for some seconds.
  for (int i = 0; i < 30; ++i) {
    face_motion(TestFace().seen(Eigen::Quaterniond::Identity(), 2.0, {320, 240}), 1.0, kCamera, 0.1 * i,
                neutral);
  }
  return face_motion(face.seen(turn, 2.0, {320, 240}), 1.0, kCamera, 3.0, neutral);
}

Eigen::Quaterniond turned(double yaw, double pitch = 0.0, double roll = 0.0) {
  return Eigen::AngleAxisd(yaw * kDeg, Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(pitch * kDeg, Eigen::Vector3d::UnitX()) *
         Eigen::AngleAxisd(roll * kDeg, Eigen::Vector3d::UnitZ());
}

/// What a face does, which coefficients show it, and which others may.
struct Movement {
  std::function<void(TestFace&)> move;
  std::vector<Expression> shown;
  std::vector<Expression> also;
};

/// What both sides can do, once on each; `by` is outwards, down, back.
std::vector<Movement> sided_movements() {
  using Move = std::function<void(TestFace&, Side)>;
  const auto out = [](Side side, double x, double y) -> Eigen::Vector3d {
    return x * TestFace::outward(side) + Eigen::Vector3d(0, y, 0);
  };
  struct Sided {
    Expression left, right;
    Move move;
    std::array<std::vector<Expression>, 2> also = {};
  };
  const std::vector<Sided> list = {
      {eye_blink_left, eye_blink_right, [](TestFace& f, Side s) { f.close_eye(s, 0.9); }},
      {eye_wide_left, eye_wide_right, [](TestFace& f, Side s) { f.close_eye(s, -0.5); }},
      {eye_squint_left,
       eye_squint_right,
       [](TestFace& f, Side s) { f.raise_lower_lid(s, 2.2); },
       {{{eye_blink_left}, {eye_blink_right}}}},
      {brow_outer_up_left, brow_outer_up_right, [](TestFace& f, Side s) { f.brow_outer(s, 7); }},
      {brow_down_left, brow_down_right, [](TestFace& f, Side s) { f.brow_inner(s, -5); }},
      {cheek_squint_left, cheek_squint_right,
       [=](TestFace& f, Side s) {
         f.move(f.on(s, {50, 205, 123}), out(s, 0, -7));
       }},
      {nose_sneer_left, nose_sneer_right,
       [=](TestFace& f, Side s) {
         f.move(f.on(s, {129, 98, 64}), out(s, 0, -6));
       }},
      {mouth_smile_left, mouth_smile_right, [=](TestFace& f, Side s) { f.move(f.corner(s), out(s, 5, -7)); }},
      {mouth_frown_left, mouth_frown_right, [=](TestFace& f, Side s) { f.move(f.corner(s), out(s, 0, 7)); }},
      {mouth_stretch_left, mouth_stretch_right,
       [=](TestFace& f, Side s) { f.move(f.corner(s), out(s, 9, 0)); }},
      {mouth_upper_up_left, mouth_upper_up_right,
       [=](TestFace& f, Side s) { f.move(f.upper_lip(s), out(s, 0, -6)); }},
      {mouth_lower_down_left, mouth_lower_down_right,
       [=](TestFace& f, Side s) { f.move(f.lower_lip(s), out(s, 0, 6)); }},
      {mouth_press_left, mouth_press_right,
       [](TestFace& f, Side s) {
         f.thin(f.on(s, {37, 39, 84, 181}), f.on(s, {82, 81, 87, 178}), 0.85);
       }},
  };
  std::vector<Movement> movements;
  for (const Sided& sided : list) {
    for (const Side side : {Side::left, Side::right}) {
      movements.push_back({[move = sided.move, side](TestFace& f) { move(f, side); },
                           {side == Side::left ? sided.left : sided.right},
                           sided.also[static_cast<std::size_t>(side)]});
    }
  }
  return movements;
}

std::vector<Movement> make_movements() {
  const std::vector<Expression> press = {mouth_press_left, mouth_press_right};
  std::vector<Movement> all = {
      {[](TestFace& f) { f.look(33 * kDeg, 0); }, {eye_look_out_left, eye_look_in_right}, {}},
      {[](TestFace& f) { f.look(-33 * kDeg, 0); }, {eye_look_in_left, eye_look_out_right}, {}},
      {[](TestFace& f) { f.look(0, 28 * kDeg); }, {eye_look_up_left, eye_look_up_right}, {}},
      {[](TestFace& f) { f.look(0, -28 * kDeg); },
       {eye_look_down_left, eye_look_down_right},
       {eye_wide_left, eye_wide_right}},
      {[](TestFace& f) {
         f.brow_inner(Side::left, 7);
         f.brow_inner(Side::right, 7);
       },
       {brow_inner_up},
       {}},
      {[](TestFace& f) {
         f.jaw({0, 25, 0});
       },
       {jaw_open},
       {}},
      {[](TestFace& f) {
         f.jaw({0, 25, 0}, true);
       },
       {jaw_open, mouth_close},
       {}},
      {[](TestFace& f) {
         f.jaw({9, 0, 0});
       },
       {jaw_left},
       {}},
      {[](TestFace& f) {
         f.jaw({-9, 0, 0});
       },
       {jaw_right},
       {}},
      {[](TestFace& f) {
         f.lips({9, 0, 0});
       },
       {Expression::mouth_left},
       {}},
      {[](TestFace& f) {
         f.lips({-9, 0, 0});
       },
       {mouth_right},
       {}},
      {[](TestFace& f) { f.narrow(0.66); }, {mouth_pucker}, {}},
      {[](TestFace& f) {
         f.narrow(0.66);
         f.move(f.lower_lip(), {0, 5, 0});
         f.move(f.upper_lip(), {0, -3, 0});
       },
       {mouth_funnel},
       {mouth_lower_down_left, mouth_lower_down_right, mouth_upper_up_left, mouth_upper_up_right}},
      {[](TestFace& f) {
         f.thin({0, 37, 39, 267, 269}, {13, 82, 81, 312, 311}, 0.8);
       },
       {mouth_roll_upper},
       press},
      {[](TestFace& f) {
         f.thin({17, 84, 181, 314, 405}, {14, 87, 178, 317, 402}, 0.8);
       },
       {mouth_roll_lower},
       {mouth_shrug_lower, mouth_press_left, mouth_press_right}},
      {[](TestFace& f) {
         f.move(f.upper_lip(), {0, -6, 0});
         f.move({87, 14, 317, 178, 402}, {0, -6, 0});
       },
       {mouth_shrug_upper},
       {}},
      {[](TestFace& f) {
         f.lips({0, -7, 0});
       },
       {mouth_shrug_lower, mouth_shrug_upper},
       {mouth_smile_left, mouth_smile_right}},
  };
  const std::vector<Movement> sided = sided_movements();
  all.insert(all.end(), sided.begin(), sided.end());
  return all;
}

const std::vector<Movement>& movements() {
  static const std::vector<Movement> all = make_movements();
  return all;
}

TestFace face_of(const Movement& movement) {
  TestFace face;
  movement.move(face);
  return face;
}

std::string_view name_of(Expression e) {
  return kExpressionNames[static_cast<std::size_t>(e)];
}

TEST(FaceExpression, NamesAreThoseOfArkit) {
  EXPECT_EQ(std::set<std::string_view>(kExpressionNames.begin(), kExpressionNames.end()).size(), 52U);
  EXPECT_TRUE(std::is_sorted(kExpressionNames.begin(), kExpressionNames.end()));
  EXPECT_EQ(name_of(tongue_out), "tongueOut");
  EXPECT_EQ(name_of(mouth_close), "mouthClose");
}

TEST(FaceExpression, RestIsZero) {
  const FaceMotion face = motion_of(TestFace());
  EXPECT_EQ(face.confidence, 1.0);
  EXPECT_LT(face.gaze.norm(), 1e-6);
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    EXPECT_NEAR(face.expressions[i], 0.0, 1e-6) << kExpressionNames[i];
  }
}

TEST(FaceExpression, EachMovementShowsInItsCoefficientsAlone) {
  std::set<Expression> covered;
  for (std::size_t d = 0; d < movements().size(); ++d) {
    const Movement& movement = movements()[d];
    const FaceMotion face = motion_of(face_of(movement));
    for (std::size_t i = 0; i < kExpressionCount; ++i) {
      const auto e = static_cast<Expression>(i);
      const auto has = [e](const std::vector<Expression>& list) {
        return std::find(list.begin(), list.end(), e) != list.end();
      };
      if (has(movement.shown)) {
        EXPECT_GT(face[e], 0.8) << name_of(e) << " of movement " << d;
        covered.insert(e);
      } else if (!has(movement.also)) {
        EXPECT_LT(face[e], 0.2) << name_of(e) << " of movement " << d << ", " << name_of(movement.shown[0]);
      }
    }
  }
  // What the points of a face do not show stays at rest.
  for (const Expression e : {cheek_puff, jaw_forward, mouth_dimple_left, mouth_dimple_right, tongue_out}) {
    EXPECT_TRUE(covered.insert(e).second) << name_of(e);
  }
  EXPECT_EQ(covered.size(), kExpressionCount);
}

TEST(FaceExpression, DoesNotChangeWithTheHead) {
  for (const Movement& movement : movements()) {
    const TestFace face = face_of(movement);
    const FaceMotion straight = motion_of(face);
    for (const double yaw : {-60.0, -30.0, 30.0, 60.0}) {
      for (const double pitch : {-25.0, 0.0, 25.0}) {
        if (std::abs(yaw) > 50.0 && name_of(movement.shown[0]).starts_with("eyeLook")) {
          continue;  // the iris of an eye that looks far aside is out of sight
        }
        const FaceMotion aside = motion_of(face, turned(yaw, pitch, 10.0));
        for (std::size_t i = 0; i < kExpressionCount; ++i) {
          EXPECT_NEAR(aside.expressions[i], straight.expressions[i], 0.05)
              << kExpressionNames[i] << ", " << name_of(movement.shown[0]) << ", yaw " << yaw << ", pitch "
              << pitch;
        }
      }
    }
  }
}

TEST(FaceExpression, MirroredFaceGivesMirroredCoefficients) {
  for (const Movement& movement : movements()) {
    const TestFace face = face_of(movement);
    TestFace mirror;
    for (std::size_t i = 0; i < kFacePoints; ++i) {
      mirror.points[TestFace::mirrored(i)] = face.points[i].cwiseProduct(Eigen::Vector3d(-1, 1, 1));
    }
    const FaceMotion a = mirrored(motion_of(face));
    const FaceMotion b = motion_of(mirror);
    EXPECT_NEAR(a.gaze.x(), b.gaze.x(), 0.01);
    for (std::size_t i = 0; i < kExpressionCount; ++i) {
      EXPECT_NEAR(a.expressions[i], b.expressions[i], 0.02)
          << kExpressionNames[i] << ", " << name_of(movement.shown[0]);
    }
  }
}

TEST(FaceExpression, MirrorTurnsTheHeadTheOtherWay) {
  FaceMotion face;
  face.head = turned(30, 20, 10);
  face[eye_blink_left] = 0.7;
  const FaceMotion m = mirrored(face);
  EXPECT_LT(m.head.angularDistance(turned(-30, 20, -10)), 1e-9);
  EXPECT_EQ(m[eye_blink_right], 0.7);
  EXPECT_EQ(m[eye_blink_left], 0.0);
}

TEST(FaceExpression, HeadAndGazeAreMeasured) {
  for (const double yaw : {-80.0, -40.0, 0.0, 15.0, 60.0}) {
    for (const double pitch : {-40.0, 0.0, 30.0}) {
      TestFace face;
      face.look(0.2, -0.1);
      const Eigen::Quaterniond turn = turned(yaw, pitch, -20.0);
      const FaceMotion seen = motion_of(face, turn);
      EXPECT_LT(seen.head.angularDistance(turn), 2.0 * kDeg) << yaw << ", " << pitch;
      if (std::abs(yaw) < 50.0) {
        EXPECT_NEAR(seen.gaze.x(), 0.2, 0.02);
        EXPECT_NEAR(seen.gaze.y(), -0.1, 0.02);
      }
    }
  }
}

TEST(FaceExpression, HeadBesideTheAxisIsTurnedWithItsRay) {
  NeutralFace neutral;
  const FaceMotion seen = face_motion(TestFace().seen(Eigen::Quaterniond::Identity(), 1.0, {620, 240}), 1.0,
                                      kCamera, 0.0, neutral);
  // A face at 26.6 degrees to the right that looks like one from the front looks into the lens.
  const Eigen::Vector3d nose = seen.head * -Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(std::atan2(nose.x(), -nose.z()), -std::atan(0.5), 0.01);
}

TEST(FaceExpression, GuessedEyesDoNotLookAbout) {
  // One eye looks up and the other down, as guessed behind dark glasses; its lids and the mouth still count.
  TestFace face;
  face.points[kLeftIris] += Eigen::Vector3d(0.0, -4.0, 0.0);
  face.points[kRightIris] += Eigen::Vector3d(0.0, 4.0, 0.0);
  const FaceMotion seen = motion_of(face);
  EXPECT_LT(seen.gaze.norm(), 1e-6);
  for (const Expression e : {eye_look_up_left, eye_look_down_left, eye_look_up_right, eye_look_down_right}) {
    EXPECT_EQ(seen[e], 0.0) << name_of(e);
  }
}

TEST(FaceExpression, HiddenEyeDoesNotMatter) {
  for (const double sign : {-1.0, 1.0}) {
    const Side hidden = sign > 0.0 ? Side::right : Side::left;
    TestFace face, garbage;
    face.look(0.0, 0.2);
    garbage.look(0.0, 0.2);
    garbage.close_eye(hidden, 1.0);
    garbage.points[hidden == Side::left ? kLeftIris : kRightIris] += Eigen::Vector3d(0.0, 5.0, -3.0);
    const FaceMotion clean = motion_of(face, turned(76.0 * sign));
    const FaceMotion seen = motion_of(garbage, turned(76.0 * sign));
    EXPECT_LT((seen.gaze - clean.gaze).norm(), 1e-6);
    for (std::size_t i = 0; i < kExpressionCount; ++i) {
      EXPECT_NEAR(seen.expressions[i], clean.expressions[i], 1e-6) << kExpressionNames[i] << ", " << sign;
    }
    // It disappears gradually.
    FaceMotion last = motion_of(garbage, turned(55.0 * sign));
    const double before = last.gaze.y();
    for (double yaw = 56.0; yaw < 80.0; yaw += 1.0) {
      const FaceMotion now = motion_of(garbage, turned(yaw * sign));
      EXPECT_LT(std::abs(now.gaze.y() - last.gaze.y()), 0.06) << yaw;
      last = now;
    }
    EXPECT_GT(last.gaze.y() - before, 0.15);
  }
}

TEST(FaceExpression, GarbageGivesFiniteValues) {
  Random random(5);
  NeutralFace neutral;
  for (int round = 0; round < 300; ++round) {
    FacePoints points;
    const double size = std::pow(10.0, random.uniform(-3.0, 6.0));
    for (Eigen::Vector3d& p : points) {
      p = size * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    }
    if (round % 7 == 0) {
      points.fill(Eigen::Vector3d::Zero());
    } else if (round % 5 == 0) {
      points[random.below(kFacePoints)].x() = std::numeric_limits<double>::quiet_NaN();
    }
    const double presence = round % 11 == 0 ? std::numeric_limits<double>::quiet_NaN() : random.uniform();
    const FaceMotion face = face_motion(points, presence, kCamera, 0.04 * round, neutral);
    EXPECT_GE(face.confidence, 0.0);
    EXPECT_LE(face.confidence, 1.0);
    EXPECT_NEAR(face.head.norm(), 1.0, 1e-9);
    EXPECT_TRUE(face.gaze.allFinite());
    for (const double value : face.expressions) {
      EXPECT_TRUE(value >= 0.0 && value <= 1.0) << value;
    }
  }
}

TEST(MeanOfLooks, IsTheMeanWithTheDifferenceAsNoise) {
  FaceMotion first, second;
  first.confidence = second.confidence = 1.0;
  first[jaw_open] = 0.2;
  second[jaw_open] = 0.6;
  second.gaze = {0.1, 0.0};
  second.head = Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY());
  const FaceMotion face = mean_of_looks(first, second);
  EXPECT_DOUBLE_EQ(face[jaw_open], 0.4);
  EXPECT_DOUBLE_EQ(face.noise.expressions[static_cast<std::size_t>(jaw_open)], 0.4);
  EXPECT_DOUBLE_EQ(face.gaze.x(), 0.05);
  EXPECT_NEAR(face.noise.gaze, 0.1, 1e-12);
  EXPECT_NEAR(face.head.angularDistance(first.head), 0.1, 1e-12) << "halfway";
  EXPECT_NEAR(face.head.angularDistance(second.head), 0.1, 1e-12);
}

TEST(MeanOfLooks, OneWithoutAFaceDoesNotCount) {
  FaceMotion face;
  face.confidence = 0.8;
  face[jaw_open] = 0.5;
  for (const FaceMotion& mean : {mean_of_looks(face, {}), mean_of_looks({}, face)}) {
    EXPECT_EQ(mean.confidence, 0.8);
    EXPECT_EQ(mean[jaw_open], 0.5);
    EXPECT_EQ(mean.noise.expressions[static_cast<std::size_t>(jaw_open)], 0.0);
  }
}

}  // namespace
}  // namespace telemime
