// SPDX-License-Identifier: Apache-2.0
#include "telemime/evaluation/head_errors.h"

#include <gtest/gtest.h>

#include "telemime/outputs/numbers.h"

namespace telemime {
namespace {

using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

MotionFrame face_of(std::int64_t t, const Quaterniond& head, double confidence = 1.0) {
  MotionFrame frame;
  frame.frame = t;
  frame.state = TrackState::tracking;
  frame.face.emplace();
  frame.face->head = head;
  frame.face->confidence = confidence;
  return frame;
}

Truth truth_of(std::vector<std::optional<Quaterniond>> heads) {
  Truth truth;
  truth.frames.resize(heads.size());
  truth.last_scored = heads.size() - 1;
  truth.heads = std::move(heads);
  return truth;
}

TEST(HeadErrors, PartsAreAboutTheAxesOfTheTrueHead) {
  const Quaterniond truth(AngleAxisd(1.2, Vector3d(0.6, 0.0, 0.8)));
  for (const Vector3d& part : {Vector3d(0.3, 0.0, 0.0), Vector3d(0.0, -0.2, 0.0), Vector3d(0.0, 0.0, 0.1)}) {
    const Quaterniond estimate = truth * AngleAxisd(part.norm(), part.normalized());
    EXPECT_LT((head_error(estimate, truth) - part).norm(), 1e-9);
    const Quaterniond same(-estimate.coeffs());
    EXPECT_LT((head_error(same, truth) - part).norm(), 1e-9);
  }
}

TEST(HeadErrors, OnlyFacesThatAreSeenCount) {
  const Quaterniond ahead = Quaterniond::Identity();
  const Quaterniond turned(AngleAxisd(0.1, Vector3d::UnitY()));
  const auto report = measure_heads({face_of(0, turned), face_of(1, turned, 0.2), face_of(2, turned)},
                                    truth_of({ahead, ahead, std::nullopt}));
  ASSERT_TRUE(report);
  EXPECT_EQ(report->heads, 2U);
  EXPECT_DOUBLE_EQ(report->seen, 0.5);
  EXPECT_NEAR(*report->angle, 0.1, 1e-9);
  EXPECT_NEAR(*report->yaw, 0.1, 1e-9);
  EXPECT_NEAR(*report->pitch, 0.0, 1e-9);
}

TEST(HeadErrors, NothingWithoutFacesOrWithoutTruth) {
  MotionFrame without = face_of(0, Quaterniond::Identity());
  without.face.reset();
  EXPECT_FALSE(measure_heads({without}, truth_of({Quaterniond::Identity()})));
  Truth unknown = truth_of({std::nullopt});
  unknown.heads.clear();
  EXPECT_FALSE(measure_heads({face_of(0, Quaterniond::Identity())}, unknown));
}

}  // namespace
}  // namespace telemime
