// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "telemime/body/landmark_points.h"
#include "telemime/core/camera.h"
#include "telemime/nets/pose_landmarks.h"

namespace telemime {

/// Where a network sees one landmark.
struct LandmarkObservation {
  bool seen = false;                                        ///< false: it says nothing
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();          ///< working image
  Eigen::Matrix2d whitening = Eigen::Matrix2d::Identity();  ///< an error in px to standard deviations
};

/// How much a network sees a bone point away from the camera.
struct BoneObservation {
  bool seen = false;
  double along = 0.0;  ///< reported share of the bone's length along the viewing ray, -1 (to the camera) to 1
  double sigma = 1.0;  ///< standard deviation of the report
  SlopeResponse response = {};  ///< what is reported of a slope on average
};

/// What a network sees of the body in one frame, as the likelihood reads it.
struct BodyLandmarks {
  std::array<LandmarkObservation, kLandmarkCount> points;
  std::array<BoneObservation, kLandmarkBoneCount> bones;
  /// Unit viewing ray through the person, camera frame: depths along bones are relative to it.
  Eigen::Vector3d ray = Eigen::Vector3d::UnitZ();
};

/// The observations of a network. `camera` is that of the picture in whose pixels the landmarks are.
BodyLandmarks observe(const PoseLandmarks& seen, const Camera& camera);

/// Error of one landmark at `point` (m, camera frame) in standard deviations; zero for one that is not seen.
Eigen::Vector2d landmark_error(const LandmarkObservation& observed, const Camera& camera,
                               const Eigen::Vector3d& point);

/// Derivative of landmark_error() by time (1/s) for a point that moves at `velocity` (m/s, camera frame);
/// zero for one that is not seen. Nearer than 5 cm its motion in depth counts nothing.
Eigen::Vector2d landmark_error_rate(const LandmarkObservation& observed, const Camera& camera,
                                    const Eigen::Vector3d& point, const Eigen::Vector3d& velocity);

/// Difference, in standard deviations, between what the network would report of a bone with this direction
/// and what it reports; 0 for one that is not seen.
double bone_error(const BoneObservation& observed, const Eigen::Vector3d& ray, const Eigen::Vector3d& bone);

/// Derivative of bone_error() by time (1/s) for a bone whose end moves at `change` (m/s, camera frame)
/// relative to its start; 0 for one that is not seen.
double bone_error_rate(const BoneObservation& observed, const Eigen::Vector3d& ray,
                       const Eigen::Vector3d& bone, const Eigen::Vector3d& change);

/// Saturating square of an error in standard deviations (Geman & McClure): an outlier costs `most` at most.
inline double robust_square(double squared, double most) {
  return squared / (1.0 + squared / most);
}
/// The most that one landmark costs, and that one bone costs.
inline constexpr double kMostLandmark = 16.0;
inline constexpr double kMostBone = 6.0;

}  // namespace telemime
