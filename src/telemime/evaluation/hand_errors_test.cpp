// SPDX-License-Identifier: Apache-2.0
#include "telemime/evaluation/hand_errors.h"

#include <gtest/gtest.h>

#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

HandPoints flat_hand(double x) {
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
  place.translation() = Eigen::Vector3d(x, 0.0, 1.0);
  return hand_points(average_hand(1.72), {}, Side::left, place);
}

// One frame: the left hand is known and seen, the right one is known but not seen.
MotionFrame seen_left() {
  MotionFrame frame;
  frame.state = TrackState::tracking;
  frame.hands.emplace();
  (*frame.hands)[0].visibility = 0.9;
  (*frame.hands)[0].joints = flat_hand(0.3);
  return frame;
}

Truth truth_of(const HandPoints& left, const HandPoints& right) {
  Truth truth;
  truth.frames.resize(1);
  truth.hands.push_back({left, right});
  return truth;
}

TEST(HandErrors, PlaceAndTurnOfTheHandDoNotCount) {
  Eigen::Isometry3d moved = Eigen::Isometry3d::Identity();
  moved.linear() = Eigen::AngleAxisd(1.0, Eigen::Vector3d(0.6, 0.8, 0.0)).toRotationMatrix();
  moved.translation() = Eigen::Vector3d(0.1, 0.2, 0.3);
  HandPoints other = flat_hand(0.0);
  for (Eigen::Vector3d& p : other) {
    p = moved * p;
  }
  EXPECT_NEAR(palm_aligned_error(other, flat_hand(0.0)), 0.0, 1e-9);
  other[8] += Eigen::Vector3d(0.015, 0.0, 0.0);  // one of the 16 joints beyond the palm
  EXPECT_NEAR(palm_aligned_error(other, flat_hand(0.0)), 0.015 / 16.0, 1e-9);
}

TEST(HandErrors, OnlyHandsThatAreSeenCount) {
  const auto report = measure_hands({seen_left()}, truth_of(flat_hand(0.0), flat_hand(-0.2)));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->hands, 2U);
  EXPECT_DOUBLE_EQ(report->seen, 0.5);
  EXPECT_NEAR(*report->palm_aligned, 0.0, 1e-9);
}

TEST(HandErrors, HandsOutsideTheImageAreNotCounted) {
  const auto report = measure_hands({seen_left()}, truth_of(flat_hand(0.0), flat_hand(-2.0)));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->hands, 1U);
}

TEST(HandErrors, ATruthOfUnknownScaleScalesThem) {
  MotionFrame frame = seen_left();
  for (Eigen::Vector3d& point : (*frame.hands)[0].joints) {
    point /= 1.25;
  }
  const Truth truth = truth_of(flat_hand(0.0), flat_hand(-0.2));
  EXPECT_NEAR(*measure_hands({frame}, truth, 1.25)->palm_aligned, 0.0, 1e-9);
  EXPECT_GT(*measure_hands({frame}, truth)->palm_aligned, 0.005);
}

TEST(HandErrors, NothingWithoutHandsInTruthOrPoses) {
  Truth without = truth_of(flat_hand(0.0), flat_hand(0.0));
  without.hands.clear();
  EXPECT_FALSE(measure_hands({seen_left()}, without));
  MotionFrame frame = seen_left();
  frame.hands.reset();
  EXPECT_FALSE(measure_hands({frame}, truth_of(flat_hand(0.0), flat_hand(0.0))));
}

TEST(HandErrors, TruthFileMayHoldHands) {
  std::string points;
  for (int j = 0; j < 21; ++j) {
    points += (j > 0 ? ",[" : "[") + std::to_string(j) + ",20,1000]";
  }
  const std::string head =
      R"({"width":640,"height":480,"fx":500,"fy":500,"cx":319.5,"cy":239.5,"joints":["root"],"positions":[[[0,0,1000]]],)";
  const Truth truth = parse_truth(head + R"("hands":{"left":[[)" + points + R"(]],"right":[null]}})", "t");
  ASSERT_EQ(truth.hands.size(), 1U);
  ASSERT_TRUE(truth.hands[0][0]);
  EXPECT_NEAR((*truth.hands[0][0])[20].x(), 0.020, 1e-12);
  EXPECT_FALSE(truth.hands[0][1]);
  EXPECT_THROW(parse_truth(head + R"("hands":{"left":[[[1,2,3]]],"right":[null]}})", "t"), Error);
}

}  // namespace
}  // namespace telemime
