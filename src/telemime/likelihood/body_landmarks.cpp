// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/body_landmarks.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace telemime {
namespace {

using Index = PoseLandmarkIndex;

// The network's index of each landmark.
constexpr std::array<int, kLandmarkCount> kIndices = {
    Index::nose,          Index::left_eye,       Index::right_eye,   Index::left_ear,    Index::right_ear,
    Index::left_shoulder, Index::right_shoulder, Index::left_elbow,  Index::right_elbow, Index::left_wrist,
    Index::right_wrist,   Index::left_pinky,     Index::right_pinky, Index::left_index,  Index::right_index,
    Index::left_hip,      Index::right_hip};

// A landmark below this says nothing: the network has guessed it.
constexpr double kLeastVisibility = 0.3;
constexpr double kLeastPresence = 0.5;
// Standard deviation of a landmark that is hardly visible over that of one that is clearly visible.
constexpr double kHidden = 4.0;
// Share of the heat map's second moment that is uncertainty: the network was taught blobs of a fixed width.
constexpr double kHeatMap = 0.1;
// m: a point behind the camera has no pixel, and counts at this distance.
constexpr double kNearest = 0.05;
// The side of the network's region in metres: the circle about an average body, enlarged by a quarter.
constexpr double kRegionSide = 2.4;

}  // namespace

BodyLandmarks observe(const PoseLandmarks& seen, const Camera& camera) {
  BodyLandmarks out;
  const double per_metre = seen.region.width / kRegionSide;
  std::array<double, kLandmarkCount> visible{};
  LandmarkPositions world;
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    const PoseLandmark& from = seen.points[static_cast<std::size_t>(kIndices[i])];
    LandmarkObservation& to = out.points[i];
    world[i] = from.world;
    visible[i] = from.presence >= kLeastPresence ? from.visibility : 0.0;
    to.seen = visible[i] >= kLeastVisibility;
    to.pixel = from.pixel;
    const double sigma = kLandmarkPoints[i].sigma * per_metre * (1.0 + (kHidden - 1.0) * (1.0 - visible[i]));
    const Eigen::Matrix2d covariance =
        sigma * sigma * Eigen::Matrix2d::Identity() + kHeatMap * from.covariance;
    to.whitening = covariance.inverse().llt().matrixU();
  }
  // Slopes are relative to the ray through the person, since the network sees a crop.
  out.ray = camera.ray(seen.region.centre).normalized();
  const auto bones = landmark_bones(world);
  constexpr std::array<std::array<Landmark, 2>, kLandmarkBoneCount> kEnds = {
      {{Landmark::l_shoulder, Landmark::l_elbow},
       {Landmark::r_shoulder, Landmark::r_elbow},
       {Landmark::l_elbow, Landmark::l_wrist},
       {Landmark::r_elbow, Landmark::r_wrist},
       {Landmark::l_shoulder, Landmark::r_shoulder},
       {Landmark::l_hip, Landmark::r_hip},
       {Landmark::nose, Landmark::nose}}};
  for (std::size_t i = 0; i < kLandmarkBoneCount; ++i) {
    const double least = std::min(visible[static_cast<std::size_t>(kEnds[i][0])],
                                  visible[static_cast<std::size_t>(kEnds[i][1])]);
    const double length = bones[i].norm();
    BoneObservation& bone = out.bones[i];
    bone.seen = least >= kLeastVisibility && length > 1e-6;
    bone.along = bone.seen ? std::clamp(bones[i].z() / length, -1.0, 1.0) : 0.0;
    bone.response = kLandmarkBoneResponse[i];
    bone.sigma = kLandmarkBoneSigma[i] * (1.0 + (kHidden - 1.0) * (1.0 - least));
  }
  return out;
}

Eigen::Vector2d landmark_error(const LandmarkObservation& observed, const Camera& camera,
                               const Eigen::Vector3d& point) {
  if (!observed.seen) {
    return Eigen::Vector2d::Zero();
  }
  const Eigen::Vector3d before(point.x(), point.y(), std::max(kNearest, point.z()));
  return observed.whitening * (camera.project(before) - observed.pixel);
}

Eigen::Vector2d landmark_error_rate(const LandmarkObservation& observed, const Camera& camera,
                                    const Eigen::Vector3d& point, const Eigen::Vector3d& velocity) {
  if (!observed.seen) {
    return Eigen::Vector2d::Zero();
  }
  const double z = std::max(kNearest, point.z());
  const double away = point.z() > kNearest ? velocity.z() / z : 0.0;
  return observed.whitening * Eigen::Vector2d(camera.fx * (velocity.x() - away * point.x()) / z,
                                              camera.fy * (velocity.y() - away * point.y()) / z);
}

double bone_error(const BoneObservation& observed, const Eigen::Vector3d& ray, const Eigen::Vector3d& bone) {
  const double length = bone.norm();
  if (!observed.seen || !(length > 0.0)) {
    return 0.0;
  }
  const SlopeResponse& response = observed.response;
  return (response.offset + response.gain * bone.dot(ray) / length - observed.along) / observed.sigma;
}

double bone_error_rate(const BoneObservation& observed, const Eigen::Vector3d& ray,
                       const Eigen::Vector3d& bone, const Eigen::Vector3d& change) {
  const double squared = bone.squaredNorm();
  if (!observed.seen || !(squared > 0.0)) {
    return 0.0;
  }
  const double along = change.dot(ray) - bone.dot(ray) * bone.dot(change) / squared;
  return observed.response.gain * along / (std::sqrt(squared) * observed.sigma);
}

}  // namespace telemime
