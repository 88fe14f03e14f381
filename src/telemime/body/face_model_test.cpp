// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/face_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "telemime/body/testing_poses.h"

namespace telemime {
namespace {

using testing_poses::kDegree;

Eigen::Quaterniond turned(double yaw, double pitch, double roll) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return AngleAxisd(roll * kDegree, Vector3d::UnitZ()) * AngleAxisd(pitch * kDegree, Vector3d::UnitX()) *
         Eigen::Quaterniond(AngleAxisd(yaw * kDegree, Vector3d::UnitY()));
}

TEST(HeadFit, TurnedFaceIsFoundExactly) {
  for (double yaw = -80.0; yaw <= 80.0; yaw += 20.0) {
    for (double pitch = -40.0; pitch <= 40.0; pitch += 20.0) {
      const Eigen::Quaterniond rotation = turned(yaw, pitch, 0.3 * yaw);
      FacePoints points;
      for (std::size_t i = 0; i < kFacePoints; ++i) {
        points[i] = 1.7 * (rotation * canonical_face()[i]) + Eigen::Vector3d(300.0, 200.0, 5.0);
      }
      const HeadFit fit = fit_head(points);
      EXPECT_LT(fit.rotation.angularDistance(rotation), 1e-6);
      EXPECT_NEAR(fit.scale, 1.7, 1e-9);
      EXPECT_LT(fit.residual, 1e-6);
      EXPECT_LT((fit.in_head(points[200]) - canonical_face()[200]).norm(), 1e-6);
    }
  }
}

// What a camera sees of a near face is not the parallel projection that the fit assumes.
TEST(HeadFit, PerspectiveTurnsTheHeadByLittle) {
  constexpr double kDistance = 900.0;  // mm
  for (double yaw = -60.0; yaw <= 60.0; yaw += 15.0) {
    const Eigen::Quaterniond rotation = turned(yaw, 10.0, 0.0);
    FacePoints points;
    for (std::size_t i = 0; i < kFacePoints; ++i) {
      const Eigen::Vector3d p = rotation * canonical_face()[i] + Eigen::Vector3d(0.0, 0.0, kDistance);
      points[i] = {p.x() * kDistance / p.z(), p.y() * kDistance / p.z(), p.z() - kDistance};
    }
    EXPECT_LT(fit_head(points).rotation.angularDistance(rotation), 1.5 * kDegree) << yaw;
  }
}

TEST(HeadFit, SomeWrongPointsCountLittle) {
  const Eigen::Quaterniond rotation = turned(40.0, -15.0, 10.0);
  FacePoints points;
  for (std::size_t i = 0; i < kFacePoints; ++i) {
    points[i] = rotation * canonical_face()[i];
  }
  for (const std::size_t wrong : {119U, 121U, 198U}) {  // a hand covers one cheek
    points[wrong] += Eigen::Vector3d(25.0, -20.0, 30.0);
  }
  EXPECT_LT(fit_head(points).rotation.angularDistance(rotation), 2.0 * kDegree);
}

TEST(HeadFit, PointsInOnePlaceAreNoHead) {
  FacePoints points;
  points.fill(Eigen::Vector3d(3.0, 4.0, 5.0));
  EXPECT_EQ(fit_head(points).residual, std::numeric_limits<double>::infinity());
  points = canonical_face();
  points[7].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(fit_head(points).residual, std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace telemime
