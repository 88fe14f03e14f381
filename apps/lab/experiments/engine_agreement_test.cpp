// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/engine.h"

#include <gtest/gtest.h>

#include <cmath>

#include "telemime/body/interpenetration.h"
#include "telemime/core/errors.h"

namespace telemime {
namespace {

TEST(Spearman, SeesTheOrderAndNothingElse) {
  const std::vector<double> a = {1.0, 2.0, 3.0, 4.0};
  EXPECT_NEAR(spearman(a, std::vector{0.1, 5.0, 5.5, 900.0}), 1.0, 1e-12);
  EXPECT_NEAR(spearman(a, std::vector{4.0, 3.0, 2.0, -7.0}), -1.0, 1e-12);
  // By hand: 1 - 6 sum d^2 / (n (n^2 - 1)), d = 1, -1, 1, -1.
  EXPECT_NEAR(spearman(a, std::vector{2.0, 1.0, 4.0, 3.0}), 0.6, 1e-12);
}

TEST(Spearman, EqualValuesShareTheMeanOfTheirRanks) {
  // Ranks 0, 1.5, 1.5, 3 and 0, 1, 2, 3: covariance 4.5, variances 4.5 and 5.
  EXPECT_NEAR(spearman(std::vector{1.0, 2.0, 2.0, 3.0}, std::vector{1.0, 2.0, 3.0, 4.0}),
              4.5 / std::sqrt(4.5 * 5.0), 1e-12);
  EXPECT_NEAR(spearman(std::vector{7.0, 7.0, 1.0}, std::vector{3.0, 3.0, 2.0}), 1.0, 1e-12);
}

TEST(Spearman, ListsWithoutOrder) {
  EXPECT_EQ(spearman(std::vector{1.0, 1.0}, std::vector{1.0, 2.0}), 0.0);
  EXPECT_EQ(spearman({}, {}), 0.0);
  EXPECT_THROW(spearman(std::vector{1.0}, {}), Error);
}

TEST(ValidPoses, KeepTheLimitsAndTheArmsOutOfTheBody) {
  const JointLimits limits = anatomical_limits();
  for (const Shape& shape : different_people()) {
    const Body body = make_body(shape);
    Random random(3);
    const std::vector<Pose> poses = valid_poses(body, limits, 100, random);
    ASSERT_EQ(poses.size(), 100U);
    for (const Pose& pose : poses) {
      ASSERT_TRUE(limits.contains(pose));
      ASSERT_LT(interpenetration(body, forward_kinematics(body, pose)), kInvalidInterpenetration);
    }
    EXPECT_NE(poses[0].angles, poses[1].angles);
  }
}

TEST(ValidPoses, SayWhenThereAreNone) {
  JointLimits limits = anatomical_limits();
  // Both hands in the chest.
  limits.min.fill(0.0);
  limits.max.fill(0.0);
  for (const Angle elbow : {Angle::l_elbow_flexion, Angle::r_elbow_flexion}) {
    limits.min[static_cast<std::size_t>(elbow)] = limits.max[static_cast<std::size_t>(elbow)] = -1.5;
  }
  const auto fix = [&](Angle angle, double value) {
    limits.min[static_cast<std::size_t>(angle)] = limits.max[static_cast<std::size_t>(angle)] = value;
  };
  fix(Angle::l_shoulder_twisting, -1.57);
  fix(Angle::r_shoulder_twisting, 1.57);
  Random random(3);
  EXPECT_THROW(valid_poses(make_body(Shape{}), limits, 1, random), Error);
}

TEST(CompareScores, ABackEndAgreesWithItself) {
  const auto a = make_scalar_backend();
  const auto b = make_scalar_backend();
  const Agreement scores = compare_scores(*a, *b, 100, 1);
  EXPECT_EQ(scores.poses, 100U);
  EXPECT_EQ(scores.region_max, 0.0);
  EXPECT_EQ(scores.contour_max, 0.0);
  const RankAgreement ranks = compare_ranks(*a, *b, 3, 1);
  EXPECT_NEAR(ranks.region_min, 1.0, 1e-12);
  EXPECT_NEAR(ranks.contour_mean, 1.0, 1e-12);
}

// The built-in cues with F shifted and D_C negated.
CueTable shifted_cues() {
  std::array cues = kCues;
  cues[cue::kRegion].cost = [](const CueInput& in) { return non_overlapping_ratio(in.reductions) + 0.25; };
  cues[cue::kContour].cost = [](const CueInput& in) {
    return -mean_edge_distance(in.reductions, in.frame.distance_cap);
  };
  return CueTable(cues);
}

TEST(CompareScores, FindsDifferences) {
  const auto reference = make_scalar_backend();
  const auto shifted = make_scalar_backend(shifted_cues());
  const Agreement scores = compare_scores(*reference, *shifted, 50, 1);
  EXPECT_NEAR(scores.region_max, 0.25, 1e-12);
  EXPECT_NEAR(scores.region_mean, 0.25, 1e-12);
  EXPECT_GT(scores.contour_max, scores.contour_mean);
  const RankAgreement ranks = compare_ranks(*reference, *shifted, 2, 1);
  EXPECT_NEAR(ranks.region_min, 1.0, 1e-9);
  EXPECT_NEAR(ranks.contour_mean, -1.0, 1e-9);
}

TEST(AgreementTables, HaveARowForEachBackEndButTheDefinition) {
  EngineOptions options;
  options.quick = true;
  options.backends = {"scalar", "simd", "simd"};
  const Table scores = agreement_table(options);
  ASSERT_EQ(scores.rows.size(), 1U);
  EXPECT_EQ(scores.rows[0].size(), scores.columns.size());
  EXPECT_EQ(scores.rows[0][0], "simd");
  EXPECT_EQ(scores.rows[0][1], "500");
  EXPECT_EQ(ranking_table(options).rows[0][1], "5");
}

}  // namespace
}  // namespace telemime
