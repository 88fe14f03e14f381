// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/vrm_expressions.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "telemime/outputs/testing_motion.h"

namespace telemime {
namespace {

using enum Expression;

double weight(const FaceMotion& face, std::string_view name) {
  const auto found = std::find(kVrmExpressionNames.begin(), kVrmExpressionNames.end(), name);
  return vrm_expressions(face)[static_cast<std::size_t>(found - kVrmExpressionNames.begin())];
}

FaceMotion with(std::initializer_list<std::pair<Expression, double>> values) {
  FaceMotion face;
  for (const auto& [expression, value] : values) {
    face[expression] = value;
  }
  return face;
}

TEST(VrmExpressions, RestIsZero) {
  for (const double value : vrm_expressions(FaceMotion{})) {
    EXPECT_EQ(value, 0.0);
  }
}

TEST(VrmExpressions, EachIsShownByWhatItIs) {
  EXPECT_GT(weight(with({{jaw_open, 0.6}}), "aa"), 0.9);
  EXPECT_GT(weight(with({{mouth_pucker, 0.9}}), "ou"), 0.8);
  EXPECT_GT(weight(with({{mouth_funnel, 0.9}, {jaw_open, 0.5}}), "oh"), 0.8);
  EXPECT_GT(weight(with({{mouth_stretch_left, 0.9},
                         {mouth_stretch_right, 0.9},
                         {mouth_lower_down_left, 0.6},
                         {mouth_lower_down_right, 0.6}}),
                   "ee"),
            0.6);
  EXPECT_GT(weight(with({{mouth_lower_down_left, 0.7}, {mouth_lower_down_right, 0.7}}), "ih"), 0.8);
  EXPECT_GT(weight(with({{mouth_smile_left, 0.9}, {mouth_smile_right, 0.9}}), "happy"), 0.9);
  EXPECT_GT(weight(with({{mouth_smile_left, 0.35}, {mouth_smile_right, 0.35}}), "relaxed"), 0.9);
  EXPECT_GT(weight(with({{brow_down_left, 0.9}, {brow_down_right, 0.9}}), "angry"), 0.9);
  EXPECT_GT(weight(with({{mouth_frown_left, 0.9}, {mouth_frown_right, 0.9}, {brow_inner_up, 0.7}}), "sad"),
            0.8);
  EXPECT_GT(weight(with({{brow_inner_up, 0.9}, {jaw_open, 0.5}}), "surprised"), 0.9);
}

TEST(VrmExpressions, EyelidsAreCountedOnce) {
  const FaceMotion wink = with({{eye_blink_left, 0.9}, {eye_blink_right, 0.1}});
  EXPECT_NEAR(weight(wink, "blink"), 0.1, 1e-12);
  EXPECT_NEAR(weight(wink, "blinkLeft"), 0.8, 1e-12);
  EXPECT_NEAR(weight(wink, "blinkRight"), 0.0, 1e-12);
}

TEST(VrmExpressions, AnyFaceGivesWeights) {
  Random random(3);
  for (int round = 0; round < 500; ++round) {
    const auto weights = vrm_expressions(testing_motion::random_face(random));
    for (const double value : weights) {
      EXPECT_GE(value, 0.0);
      EXPECT_LE(value, 1.0);
    }
    EXPECT_LE(weights[5] + weights[6] + weights[7] + weights[8] + weights[9], 1.0 + 1e-9);
  }
}

}  // namespace
}  // namespace telemime
