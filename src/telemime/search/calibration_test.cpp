// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/calibration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "telemime/body/testing_poses.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

TEST(Calibration, PlacesTheHeadWhereItIsSeen) {
  const Camera camera = camera_from_field_of_view(320, 240, 60.0);
  for (const Shape& shape : {Shape{}, testing_poses::other_shape()}) {
    const Body body = make_body(shape);
    for (const HeadRegion& head : {HeadRegion{{160, 80}, {14, 20}, true}, HeadRegion{{90, 60}, {8, 11}, true},
                                   HeadRegion{{250, 150}, {30, 42}, true}}) {
      const Kinematics k = forward_kinematics(body, place_at_head(body, head, camera));
      const Eigen::Vector2d top = camera.project(k.joints[Joint::head_top]);
      const Eigen::Vector2d middle =
          camera.project(0.5 * (k.joints[Joint::head_top] + k.joints[Joint::neck]));
      EXPECT_NEAR(top.y(), head.centre.y() - head.radii.y(), 0.25 * head.radii.y());
      EXPECT_LT((middle - head.centre).norm(), 0.35 * head.radii.y());
    }
  }
}

TEST(Calibration, HeadOfHalfTheSizeIsTwiceAsFar) {
  const Camera camera = camera_from_field_of_view(320, 240, 60.0);
  const Body body = make_body(Shape{});
  const auto distance = [&](double radius) {
    const Pose pose = place_at_head(body, {{160, 80}, {0.7 * radius, radius}, true}, camera);
    return forward_kinematics(body, pose).joints[Joint::head].z();
  };
  EXPECT_NEAR(distance(10) / distance(20), 2.0, 0.1);
  EXPECT_TRUE(std::isfinite(distance(0.0))) << "a head without a size";
}

TEST(Calibration, ConfigRefusesValuesByName) {
  EXPECT_NO_THROW(check_settings(CalibrationConfig{}));
  testing_errors::expect_refused<CalibrationConfig>({
      {"height", [](auto& c) { c.stature = 0.2; }},
      {"height", [](auto& c) { c.stature = 17.0; }},
      {"height", [](auto& c) { c.stature = std::numeric_limits<double>::quiet_NaN(); }},
      {"nearest", [](auto& c) { c.nearest = 6.0; }},
      {"rounds", [](auto& c) { c.rounds = 0; }},
      {"pose_iterations", [](auto& c) { c.pose_iterations = 1; }},
      {"arm_samples", [](auto& c) { c.arms.samples = -1; }},
      {"arm_kept", [](auto& c) { c.arms.kept = 0; }},
      {"shape_iterations", [](auto& c) { c.shape.iterations = 0; }},
      {"length_spread", [](auto& c) { c.shape.length_spread = 0.0; }},
      {"worst_region", [](auto& c) { c.worst_region = 1.5; }},
      {"fronto_parallel", [](auto& c) { c.fronto_parallel = -1.0; }},
      {"look_ahead", [](auto& c) { c.look_ahead = -1; }},
      {"keyframes", [](auto& c) { c.refine.keyframes = 0; }},
      {"refine_rounds", [](auto& c) { c.refine.rounds = -1; }},
      {"refine_iterations", [](auto& c) { c.refine.pose_iterations = 0; }},
      {"refine_shapes", [](auto& c) { c.refine.shapes = -1; }},
      {"refine_prior_weight", [](auto& c) { c.refine.prior_weight = -1.0; }},
      {"refine_natural_weight", [](auto& c) { c.refine.natural_weight = std::nan(""); }},
      {"prior_weight", [](auto& c) { c.shape.prior_weight = -1.0; }},
      {"contour_weight", [](auto& c) { c.shape.contour_weight = -1.0; }},
  });
}

}  // namespace
}  // namespace telemime
