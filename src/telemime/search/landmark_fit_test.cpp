// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/landmark_fit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "telemime/body/arm_ik.h"
#include "telemime/core/random.h"
#include "telemime/likelihood/testing_landmarks.h"

namespace telemime {
namespace {

// What networks see of a pose; the standard deviations of the noise are `pixels` and `slope`.
BodyLandmarks observe(const Body& body, const Camera& camera, const Pose& pose, double pixels, double slope,
                      Random& random) {
  BodyLandmarks seen = testing_landmarks::perfect_landmarks(body, pose, camera);
  for (LandmarkObservation& point : seen.points) {
    point.pixel += Eigen::Vector2d(random.normal(0, pixels), random.normal(0, pixels));
  }
  for (BoneObservation& bone : seen.bones) {
    bone.along += random.normal(0, slope);
  }
  return seen;
}

Pose random_gesture(Random& random, const JointLimits& limits) {
  Pose pose;
  pose.root = {random.uniform(-0.2, 0.2), random.uniform(0.2, 0.4), random.uniform(0.9, 1.8)};
  pose[Angle::root_torsion] = random.uniform(-0.5, 0.5);
  pose[Angle::root_tilt] = random.uniform(-0.1, 0.25);
  pose[Angle::neck_torsion] = random.uniform(-0.4, 0.4);
  set_arm_angles(pose, Side::left,
                 {random.uniform(-1.2, 0.2), random.uniform(-0.8, 0.2), random.uniform(0.0, 1.0),
                  random.uniform(-2.0, -0.3)});
  set_arm_angles(pose, Side::right,
                 {random.uniform(-1.2, 0.2), random.uniform(-0.2, 0.8), random.uniform(-1.0, 0.0),
                  random.uniform(-2.0, -0.3)});
  return limits.clamp(pose);
}

double worst_arm_error(const Body& body, const Pose& a, const Pose& b) {
  const JointPositions p = forward_kinematics(body, a).joints;
  const JointPositions q = forward_kinematics(body, b).joints;
  const Eigen::Vector3d shift = mid_shoulders(p) - mid_shoulders(q);
  double worst = 0.0;
  for (const Joint j : {Joint::l_elbow, Joint::r_elbow, Joint::l_wrist, Joint::r_wrist}) {
    worst = std::max(worst, (p[j] - q[j] - shift).norm());
  }
  return worst;
}

// Bounds the median and the 90 % quantile of the errors (m) of the poses that `find` finds from what networks
// see of 60 gestures.
template <typename Find>
void expect_found(double pixels, double slope, double median, const Find& find) {
  const Body body = make_body({});
  const JointLimits limits = anatomical_limits();
  const Camera camera = camera_from_field_of_view(320, 240, 60.0);
  Random random(3);
  std::vector<double> errors;
  for (int i = 0; i < 60; ++i) {
    const Pose truth = random_gesture(random, limits);
    BodyLandmarks seen = observe(body, camera, truth, pixels, slope, random);
    errors.push_back(worst_arm_error(body, find(body, camera, seen, limits), truth));
  }
  std::sort(errors.begin(), errors.end());
  EXPECT_LT(errors[30], median);
  EXPECT_LT(errors[54], 0.15);
}

TEST(LandmarkFit, FindsAPoseWithoutAnyStart) {
  expect_found(0.3, 0.1, 0.06,
               [](const Body& body, const Camera& camera, BodyLandmarks& seen, const JointLimits& limits) {
                 const auto start = pose_from_landmarks(body, camera, seen, limits);
                 EXPECT_TRUE(start.has_value());
                 const auto fits = landmark_proposals(body, camera, seen, {.pose = start.value()}, limits, 4);
                 EXPECT_TRUE(limits.contains(fits.at(0).pose, 1e-6));
                 return fits[0].pose;
               });
}

TEST(LandmarkFit, FindsAPoseFromFlattenedSlopes) {
  // Networks report the slopes of arms with the offsets and gains of the table.
  expect_found(0.0, 0.0, 0.05,
               [](const Body& body, const Camera& camera, BodyLandmarks& seen, const JointLimits& limits) {
                 for (std::size_t i = 0; i < kLandmarkBoneCount; ++i) {
                   const SlopeResponse& response = kLandmarkBoneResponse[i];
                   seen.bones[i].response = response;
                   seen.bones[i].along = response.offset + response.gain * seen.bones[i].along;
                 }
                 return pose_from_landmarks(body, camera, seen, limits).value();
               });
}

TEST(LandmarkFit, FollowsThroughAnOutlier) {
  const Body body = make_body({});
  const JointLimits limits = anatomical_limits();
  const Camera camera = camera_from_field_of_view(320, 240, 60.0);
  Random random(5);
  const Pose truth = random_gesture(random, limits);
  BodyLandmarks seen = observe(body, camera, truth, 0.0, 0.0, random);
  seen.points[static_cast<std::size_t>(Landmark::l_wrist)].pixel += Eigen::Vector2d(120.0, -60.0);
  const LandmarkPrior prior{.pose = truth, .following = 0.1};
  const LandmarkFit fit = fit_to_landmarks(body, camera, seen, prior, truth, limits);
  EXPECT_LT(worst_arm_error(body, fit.pose, truth), 0.05);
}

// Where landmarks and prior agree, Gauss-Newton steps with exact derivatives converge quadratically.
TEST(LandmarkFit, ConvergesToAPerfectFit) {
  const Body body = make_body({});
  const JointLimits limits = anatomical_limits();
  const Camera camera = camera_from_field_of_view(320, 240, 60.0);
  Random random(7);
  for (int i = 0; i < 20; ++i) {
    const Pose truth = random_gesture(random, limits);
    const BodyLandmarks seen = observe(body, camera, truth, 0.0, 0.0, random);
    PoseVector start = truth.vector();
    for (double& number : start) {
      number += random.normal(0.0, 0.05);
    }
    for (const double following : {0.0, 0.1}) {
      const LandmarkFit fit = fit_to_landmarks(body, camera, seen, {.pose = truth, .following = following},
                                               Pose::from_vector(start), limits);
      EXPECT_LT(fit.cost, 1e-9) << i << " " << following;
      EXPECT_LT((fit.pose.vector() - truth.vector()).norm(), 1e-4) << i << " " << following;
    }
  }
}

TEST(LandmarkFit, NeedsAPairOfLandmarks) {
  EXPECT_FALSE(pose_from_landmarks(make_body({}), Camera{}, BodyLandmarks{}, anatomical_limits()));
}

}  // namespace
}  // namespace telemime
