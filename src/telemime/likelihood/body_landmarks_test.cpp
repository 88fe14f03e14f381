// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/body_landmarks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace telemime {
namespace {

// A person of whom all is visible; both arms point 30 degrees out of the picture, towards the camera.
PoseLandmarks arms_forward() {
  PoseLandmarks seen;
  seen.region = {.centre = {319.5, 239.5}, .width = 400.0, .height = 400.0};
  for (PoseLandmark& point : seen.points) {
    point.visibility = point.presence = 1.0;
  }
  const Eigen::Vector3d along(std::sqrt(0.75), 0.0, -0.5);
  for (const int left : {1, 0}) {
    const Eigen::Vector3d shoulder(left == 1 ? 0.2 : -0.2, -0.5, 0.0);
    const Eigen::Vector3d step = 0.25 * Eigen::Vector3d(left == 1 ? along.x() : -along.x(), 0.0, along.z());
    const auto set = [&](int left_index, int right_index, const Eigen::Vector3d& place) {
      seen.points[static_cast<std::size_t>(left == 1 ? left_index : right_index)].world = place;
    };
    set(PoseLandmarkIndex::left_shoulder, PoseLandmarkIndex::right_shoulder, shoulder);
    set(PoseLandmarkIndex::left_elbow, PoseLandmarkIndex::right_elbow, shoulder + step);
    set(PoseLandmarkIndex::left_wrist, PoseLandmarkIndex::right_wrist, shoulder + 2.0 * step);
  }
  return seen;
}

TEST(BodyLandmarks, SlopesOfArmsAreExpectedFlattened) {
  const BodyLandmarks seen = observe(arms_forward(), Camera{});
  for (const LandmarkBone name : {LandmarkBone::l_upper_arm, LandmarkBone::r_upper_arm,
                                  LandmarkBone::l_forearm, LandmarkBone::r_forearm}) {
    const auto i = static_cast<std::size_t>(name);
    const BoneObservation& bone = seen.bones[i];
    ASSERT_TRUE(bone.seen);
    EXPECT_NEAR(bone.along, -0.5, 1e-12);
    EXPECT_DOUBLE_EQ(bone.sigma, kLandmarkBoneSigma[i]);
    // The bone that explains the report slopes as the table says, which is not the report itself.
    const double slope = (bone.along - kLandmarkBoneResponse[i].offset) / kLandmarkBoneResponse[i].gain;
    const Eigen::Vector3d likely(std::sqrt(1.0 - slope * slope), 0.0, slope);
    EXPECT_NEAR(bone_error(bone, Eigen::Vector3d::UnitZ(), 0.3 * likely), 0.0, 1e-12);
    const Eigen::Vector3d reported(std::sqrt(0.75), 0.0, -0.5);
    EXPECT_GT(std::abs(bone_error(bone, Eigen::Vector3d::UnitZ(), reported)), 0.1);
  }
}

TEST(BodyLandmarks, SlopesOfTheTrunkAreBelieved) {
  const BodyLandmarks seen = observe(arms_forward(), Camera{});
  const BoneObservation& shoulders = seen.bones[static_cast<std::size_t>(LandmarkBone::shoulders)];
  EXPECT_TRUE(shoulders.seen);
  EXPECT_NEAR(bone_error(shoulders, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitX()), 0.0, 1e-12);
}

TEST(BodyLandmarks, ABoneThatIsNotSeenSaysNothing) {
  const Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();
  EXPECT_EQ(bone_error({.seen = false, .along = 1.0}, ray, Eigen::Vector3d::UnitX()), 0.0);
  EXPECT_EQ(bone_error({.seen = true, .along = 1.0}, ray, Eigen::Vector3d::Zero()), 0.0);
}

// Central differences of an error of a point or bone that moves.
template <typename Number>
Number measured_rate(const std::function<Number(const Eigen::Vector3d&)>& error, const Eigen::Vector3d& at,
                     const Eigen::Vector3d& velocity) {
  constexpr double kStep = 1e-6;
  return (error(at + kStep * velocity) - error(at - kStep * velocity)) / (2 * kStep);
}

TEST(BodyLandmarks, RatesAreTheDerivativesOfTheErrors) {
  LandmarkObservation point{.seen = true, .pixel = {300.0, 200.0}};
  point.whitening << 0.5, 0.2, 0.0, 0.7;
  const Camera camera;
  BoneObservation bone{.seen = true, .along = 0.3, .sigma = 0.2, .response = {-0.1, 0.6}};
  const Eigen::Vector3d ray = Eigen::Vector3d(0.1, -0.2, 1.0).normalized();
  for (const Eigen::Vector3d& at :
       {Eigen::Vector3d(0.2, 0.1, 1.4), Eigen::Vector3d(-0.1, 0.3, 0.2), Eigen::Vector3d(0.1, 0.1, -1.0)}) {
    for (const Eigen::Vector3d& velocity :
         {Eigen::Vector3d(1.0, 0.0, 0.0), Eigen::Vector3d(0.0, -1.0, 0.5), Eigen::Vector3d(0.3, 0.2, -1.0)}) {
      const auto of_point = [&](const Eigen::Vector3d& p) -> Eigen::Vector2d {
        return landmark_error(point, camera, p);
      };
      const Eigen::Vector2d moves = measured_rate<Eigen::Vector2d>(of_point, at, velocity);
      EXPECT_LT((landmark_error_rate(point, camera, at, velocity) - moves).norm(), 1e-4 * (1 + moves.norm()));
      const auto of_bone = [&](const Eigen::Vector3d& b) { return bone_error(bone, ray, b); };
      EXPECT_NEAR(bone_error_rate(bone, ray, at, velocity), measured_rate<double>(of_bone, at, velocity),
                  1e-6);
    }
  }
  point.seen = bone.seen = false;
  EXPECT_EQ(landmark_error_rate(point, camera, ray, ray), Eigen::Vector2d(0.0, 0.0));
  EXPECT_EQ(bone_error_rate(bone, ray, ray, Eigen::Vector3d::UnitX()), 0.0);
}

}  // namespace
}  // namespace telemime
