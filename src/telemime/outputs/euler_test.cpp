// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/euler.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "telemime/body/rotations.h"
#include "telemime/core/random.h"

namespace telemime {
namespace {

constexpr std::array<AxisOrder, 6> kOrders = {
    {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
constexpr double kHalfTurn = std::numbers::pi;

TEST(Euler, DecomposingAComposedRotationGivesTheAnglesBack) {
  Random random(1);
  for (const AxisOrder& order : kOrders) {
    for (int n = 0; n < 200; ++n) {
      const EulerAngles angles = {random.uniform(-kHalfTurn, kHalfTurn),
                                  random.uniform(-kHalfTurn, kHalfTurn),
                                  random.uniform(-kHalfTurn, kHalfTurn)};
      const EulerAngles found = decompose(compose(order, angles), order, angles);
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(wrap_angle(found[i] - angles[i]), 0.0, 1e-6);
      }
    }
  }
}

TEST(Euler, BothBranchesAreTheSameRotation) {
  Random random(2);
  for (const AxisOrder& order : kOrders) {
    const EulerAngles angles = {0.3, -0.8, random.uniform(-1.0, 1.0)};
    const Eigen::Matrix3d rotation = compose(order, angles);
    const EulerAngles twin =
        decompose(rotation, order, {0.3 + kHalfTurn, kHalfTurn + 0.8, angles[2] + kHalfTurn});
    EXPECT_GT(std::abs(wrap_angle(twin[0] - angles[0])), 3.0);
    EXPECT_TRUE(compose(order, twin).isApprox(rotation, 1e-12));
  }
}

TEST(Euler, KeepsTheInnermostAngleWhereTheAnglesAreSingular) {
  for (const AxisOrder& order : kOrders) {
    for (const double middle : {kHalfTurn / 2.0, -kHalfTurn / 2.0}) {
      const Eigen::Matrix3d rotation = compose(order, {0.4, middle, 0.9});
      const EulerAngles found = decompose(rotation, order, {0.4, middle, 0.9});
      EXPECT_NEAR(found[0], 0.4, 1e-6);
      EXPECT_NEAR(found[2], 0.9, 1e-6);
      EXPECT_TRUE(compose(order, decompose(rotation, order, {})).isApprox(rotation, 1e-6));
    }
  }
}

TEST(Euler, AgreesWithTheBodysOwnOrder) {
  EXPECT_TRUE(compose({2, 0, 1}, {0.1, 0.2, 0.3}).isApprox(compose_zxy({0.1, 0.2, 0.3}), 1e-15));
}

}  // namespace
}  // namespace telemime
