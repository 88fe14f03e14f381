// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/packed_rotation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "telemime/core/random.h"
#include "telemime/outputs/numbers.h"

namespace telemime::meeting {
namespace {

constexpr double kWorst = 0.01;  // degrees

Eigen::Quaterniond any_rotation(Random& random) {
  return Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
}

/// Angle between a rotation and what comes back, degrees.
double error_of(const Eigen::Quaterniond& q) {
  const auto back = unpack_rotation(pack_rotation(q));
  return back ? q.angularDistance(*back) * kDegreesPerRadian : 360.0;
}

/// Rotations where components are as large, 0, or change their rank, of either sign.
std::vector<Eigen::Quaterniond> edge_rotations() {
  std::vector<Eigen::Quaterniond> edges;
  const std::vector<double> values = {0.0, 1e-9, 0.5, std::numbers::sqrt2 / 2.0, 1.0};
  for (const double w : values) {
    for (const double x : values) {
      for (const double y : values) {
        for (const double z : values) {
          for (unsigned signs = 0; signs < 16 && w + x + y + z > 0.1; ++signs) {
            const auto sign = [signs](unsigned bit) { return (signs >> bit & 1U) != 0 ? -1.0 : 1.0; };
            edges.push_back(
                Eigen::Quaterniond(sign(0) * w, sign(1) * x, sign(2) * y, sign(3) * z).normalized());
          }
        }
      }
    }
  }
  return edges;
}

TEST(PackedRotation, ErrorIsBelowAHundredthOfADegree) {
  double worst = 0.0;
  Random random(1);
  for (int i = 0; i < 200'000; ++i) {
    worst = std::max(worst, error_of(any_rotation(random)));
  }
  for (const Eigen::Quaterniond& q : edge_rotations()) {
    worst = std::max(worst, error_of(q));
  }
  EXPECT_LT(worst, kWorst);
  EXPECT_GT(worst, kWorst / 5.0) << "the rotations are no hard ones";
}

TEST(PackedRotation, IsEqualForAQuaternionAndItsNegative) {
  Random random(2);
  const auto expect_same = [](const Eigen::Quaterniond& q) {
    EXPECT_EQ(pack_rotation(q), pack_rotation(Eigen::Quaterniond(-q.coeffs())));
  };
  for (int i = 0; i < 10'000; ++i) {
    expect_same(any_rotation(random));
  }
  for (const Eigen::Quaterniond& q : edge_rotations()) {
    expect_same(q);
  }
}

TEST(PackedRotation, LengthDoesNotMatter) {
  const Eigen::Quaterniond q(0.1, -0.7, 0.3, 0.2);
  EXPECT_EQ(pack_rotation(q), pack_rotation(Eigen::Quaterniond(3.0 * q.coeffs())));
}

TEST(PackedRotation, HasTheDocumentedBits) {
  // Identity: w is the largest, 0 is floor(16383.5 + 0.5).
  const std::uint64_t zero = 16384;
  EXPECT_EQ(pack_rotation(Eigen::Quaterniond::Identity()),
            zero | zero << 15U | zero << 30U | std::uint64_t{3} << 45U);
  // Half a turn about z: x, y and w stay.
  EXPECT_EQ(pack_rotation(Eigen::Quaterniond(0, 0, 0, 1)),
            zero | zero << 15U | zero << 30U | std::uint64_t{2} << 45U);
  // Two as large: the first is left out, the other is all ones.
  const double half = std::numbers::sqrt2 / 2.0;
  EXPECT_EQ(pack_rotation(Eigen::Quaterniond(half, half, 0, 0)),
            zero | zero << 15U | std::uint64_t{32767} << 30U);
  for (int i = 0; i < 1000; ++i) {
    Random random(static_cast<std::uint64_t>(i));
    EXPECT_EQ(pack_rotation(any_rotation(random)) >> kPackedRotationBits, 0U);
  }
}

TEST(PackedRotation, EveryPatternIsARotationOrRejected) {
  Random random(3);
  int refused = 0;
  for (int i = 0; i < 100'000; ++i) {
    const std::uint64_t bits = random.bits();
    const auto q = unpack_rotation(bits);
    refused += q ? 0 : 1;
    ASSERT_TRUE(!q || std::abs(q->norm() - 1.0) < 1e-12);
    ASSERT_TRUE(!q || error_of(*q) < kWorst);
  }
  EXPECT_GT(refused, 1000);
  EXPECT_LT(refused, 99'000);
}

TEST(PackedRotation, SquaresMayExceedOneByAThousandth) {
  const auto packed = [](double a, double b, double c) {
    const auto step = [](double v) {
      return static_cast<std::uint64_t>(std::lround((v * std::numbers::sqrt2 + 1.0) / 2.0 * 32767.0));
    };
    return step(a) | step(b) << 15U | step(c) << 30U;
  };
  const double a = std::numbers::sqrt2 / 2.0;
  const auto just = unpack_rotation(packed(a, a, 0.03));  // 1.0009
  ASSERT_TRUE(just);
  EXPECT_NEAR(just->norm(), 1.0, 1e-12);
  EXPECT_EQ(just->x(), 0.0);
  EXPECT_FALSE(unpack_rotation(packed(a, a, 0.033)));  // 1.0011
}

}  // namespace
}  // namespace telemime::meeting
