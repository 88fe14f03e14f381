// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/rotations.h"

#include <gtest/gtest.h>

#include <numbers>

#include "telemime/core/random.h"

namespace telemime {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Rotations, TurnByTheRightHandRule) {
  const Eigen::Vector3d x(1, 0, 0);
  const Eigen::Vector3d y(0, 1, 0);
  const Eigen::Vector3d z(0, 0, 1);
  EXPECT_LT((rotation_x(kPi / 2) * y - z).norm(), 1e-15);
  EXPECT_LT((rotation_y(kPi / 2) * z - x).norm(), 1e-15);
  EXPECT_LT((rotation_z(kPi / 2) * x - y).norm(), 1e-15);
}

TEST(Rotations, ComposeAppliesYFirstThenXThenZ) {
  const AnglesZxy a = {0.3, -0.5, 0.9};
  EXPECT_TRUE(compose_zxy(a).isApprox(rotation_z(0.3) * rotation_x(-0.5) * rotation_y(0.9), 1e-14));
}

TEST(Rotations, BothDecompositionsGiveTheRotationBack) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const AnglesZxy angles = {random.uniform(-kPi, kPi), random.uniform(-kPi, kPi),
                              random.uniform(-kPi, kPi)};
    const Eigen::Matrix3d r = compose_zxy(angles);
    const auto both = decompose_zxy(r);
    for (const AnglesZxy& found : both) {
      ASSERT_LT((compose_zxy(found) - r).norm(), 1e-7);
      for (const double a : {found.x, found.y, found.z}) {
        ASSERT_GT(a, -kPi - 1e-12);
        ASSERT_LE(a, kPi + 1e-12);
      }
    }
    ASSERT_LE(std::abs(both[0].x), kPi / 2 + 1e-12);
    ASSERT_GE(std::abs(both[1].x), kPi / 2 - 1e-12);
    // One of the two is what went in.
    const auto miss = [&](const AnglesZxy& f) {
      return std::abs(wrap_angle(f.x - angles.x)) + std::abs(wrap_angle(f.y - angles.y)) +
             std::abs(wrap_angle(f.z - angles.z));
    };
    ASSERT_LT(std::min(miss(both[0]), miss(both[1])), 1e-5);
  }
}

TEST(Rotations, GimbalLockKeepsTheRotationAndSetsYToZero) {
  for (const double x : {kPi / 2, -kPi / 2}) {
    for (const double z : {-2.5, 0.0, 0.7, 3.0}) {
      for (const double y : {-1.2, 0.0, 2.9}) {
        const Eigen::Matrix3d r = compose_zxy({z, x, y});
        const auto both = decompose_zxy(r);
        EXPECT_EQ(both[0].y, 0.0);
        for (const AnglesZxy& found : both) {
          EXPECT_LT((compose_zxy(found) - r).norm(), 1e-8) << x << " " << y << " " << z;
        }
      }
    }
  }
}

TEST(Rotations, NearGimbalLockTheRotationIsStillRight) {
  for (const double away : {1e-3, 1e-5, 1e-7, 1e-8, 1e-10, 1e-12}) {
    const Eigen::Matrix3d r = compose_zxy({0.4, kPi / 2 - away, -1.1});
    for (const AnglesZxy& found : decompose_zxy(r)) {
      EXPECT_LT((compose_zxy(found) - r).norm(), 1e-6) << away;
    }
  }
}

TEST(Rotations, BetweenTwoDirectionsIsTheShortest) {
  Random random(2);
  const auto direction = [&random] {
    return Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  };
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d from = direction();
    const Eigen::Vector3d to = i % 10 == 0 ? Eigen::Vector3d(-2.0 * from) : direction();
    const Eigen::AngleAxisd turn(rotation_between(from, to));
    ASSERT_LT((turn * from.normalized() - to.normalized()).norm(), 1e-7);
    ASSERT_NEAR(std::cos(turn.angle()), from.normalized().dot(to.normalized()), 1e-7);
  }
}

TEST(Rotations, BestRotationIsTheOneOfThePointsAndNeverAMirror) {
  Random random(3);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Matrix3d rotation =
        compose_zxy({random.uniform(-kPi, kPi), random.uniform(-kPi, kPi), random.uniform(-kPi, kPi)});
    Eigen::Matrix<double, 3, 6> from;
    for (double& value : from.reshaped()) {
      value = random.uniform(-1, 1);
    }
    from.colwise() -= from.rowwise().mean().eval();
    const Eigen::Matrix<double, 3, 6> to = rotation * from;
    ASSERT_LT((best_rotation(to * from.transpose()) - rotation).norm(), 1e-9);
    const Eigen::Matrix3d best = best_rotation(-to * from.transpose());  // of mirrored points
    ASSERT_NEAR(best.determinant(), 1.0, 1e-9);
    for (const double angle : {-0.1, 0.1}) {
      for (const Eigen::Vector3d axis :
           {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()}) {
        const Eigen::Matrix3d other = Eigen::AngleAxisd(angle, axis) * best;
        ASSERT_LE((to + best * from).norm(), (to + other * from).norm() + 1e-9);
      }
    }
  }
}

TEST(Rotations, WrapKeepsTheAngleUpToWholeTurns) {
  for (double a = -20.0; a < 20.0; a += 0.37) {
    const double w = wrap_angle(a);
    EXPECT_GT(w, -kPi);
    EXPECT_LE(w, kPi);
    EXPECT_NEAR(std::remainder(w - a, 2 * kPi), 0.0, 1e-12);
  }
  EXPECT_EQ(wrap_angle(kPi), kPi);
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_EQ(wrap_angle(0.0), 0.0);
}

}  // namespace
}  // namespace telemime
