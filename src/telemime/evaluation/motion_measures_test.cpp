// SPDX-License-Identifier: Apache-2.0
#include "telemime/evaluation/motion_measures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "telemime/outputs/numbers.h"

namespace telemime {
namespace {

// Shoulders whose line is turned by so many degrees about the vertical; seen from in front at 0.
TruthJoints turned(double degrees) {
  const double angle = degrees / kDegreesPerRadian;
  const Eigen::Vector3d half = 0.17 * Eigen::Vector3d(std::cos(angle), 0.1, std::sin(angle));
  const Eigen::Vector3d middle(0.3, -0.2, 1.5);
  TruthJoints joints;
  joints[static_cast<std::size_t>(Joint::l_shoulder)] = middle + half;
  joints[static_cast<std::size_t>(Joint::r_shoulder)] = middle - half;
  return joints;
}

TEST(Turn, IsTheDirectionOfTheShouldersAboutTheVertical) {
  const JointTrack truth = {turned(0), turned(-20), turned(60), turned(-132)};
  const auto same = measure_turn(truth, truth);
  ASSERT_TRUE(same);
  EXPECT_EQ(same->frames, 4U);
  EXPECT_NEAR(same->error, 0.0, 1e-12);
  EXPECT_EQ(same->turned, 3U);
  EXPECT_EQ(same->wrong_way, 0U);

  const auto other = measure_turn({turned(-4), turned(-26), turned(52), turned(-122)}, truth);
  ASSERT_TRUE(other);
  EXPECT_NEAR(other->error * kDegreesPerRadian, (4 + 6 + 8 + 10) / 4.0, 1e-9);
  EXPECT_NEAR(*other->error_turned * kDegreesPerRadian, (6 + 8 + 10) / 3.0, 1e-9);
  EXPECT_EQ(other->wrong_way, 0U);
}

TEST(Turn, TheOtherSideIsTheWrongWayAndFarAwayIsTheShortWayRound) {
  const auto report =
      measure_turn({turned(20), turned(179), turned(5)}, {turned(-20), turned(-179), turned(-5)});
  ASSERT_TRUE(report);
  EXPECT_EQ(report->turned, 1U) << "a line nearly in the image plane has no side, seen from behind either";
  EXPECT_EQ(report->wrong_way, 1U);
  EXPECT_NEAR(report->error * kDegreesPerRadian, (40 + 2 + 10) / 3.0, 1e-9);
}

TEST(Turn, CountsOnlyFramesWithAllShoulders) {
  TruthJoints one = turned(30);
  one[static_cast<std::size_t>(Joint::r_shoulder)].reset();
  const auto report = measure_turn({turned(30), std::nullopt, turned(30), turned(0)},
                                   {turned(30), turned(30), one, turned(0)});
  ASSERT_TRUE(report);
  EXPECT_EQ(report->frames, 2U);
  EXPECT_EQ(report->turned, 1U);
  const auto facing = measure_turn({turned(3)}, {turned(1)});
  ASSERT_TRUE(facing);
  EXPECT_FALSE(facing->error_turned);
  EXPECT_FALSE(measure_turn({turned(30)}, {std::nullopt}));
  EXPECT_FALSE(measure_turn({}, {turned(30)}));
}

}  // namespace
}  // namespace telemime
