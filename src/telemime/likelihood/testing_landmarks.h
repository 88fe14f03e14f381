// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/likelihood/body_landmarks.h"

/// Landmarks for tests of several modules. Not installed.
namespace telemime::testing_landmarks {

/// What perfect networks would see of a body in this pose: every landmark and slope at its true place.
inline BodyLandmarks perfect_landmarks(const Body& body, const Pose& pose, const Camera& camera) {
  BodyLandmarks seen;
  const LandmarkPositions points = landmark_positions(body, forward_kinematics(body, pose));
  const auto bones = landmark_bones(points);
  seen.ray = points[static_cast<std::size_t>(Landmark::nose)].normalized();
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const double sigma = kLandmarkPoints[i].sigma * camera.fx / points[i].z();
    seen.points[i] = {
        .seen = true, .pixel = camera.project(points[i]), .whitening = Eigen::Matrix2d::Identity() / sigma};
  }
  for (std::size_t i = 0; i < kLandmarkBoneCount; ++i) {
    seen.bones[i] = {.seen = true, .along = bones[i].dot(seen.ray) / bones[i].norm(), .sigma = 0.3};
  }
  return seen;
}

}  // namespace telemime::testing_landmarks
