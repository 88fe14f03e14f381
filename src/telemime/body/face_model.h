// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>

namespace telemime {

inline constexpr std::size_t kFaceMeshPoints = 468;
inline constexpr std::size_t kFacePoints = 478;
inline constexpr std::size_t kRightIris = 468;  ///< its middle, before four points of its edge
inline constexpr std::size_t kLeftIris = 473;

/// Points of a face, numbered as MediaPipe's face mesh: 468 of the surface and five of each iris; x to the
/// right of the picture, y down, z away from the camera.
using FacePoints = std::array<Eigen::Vector3d, kFacePoints>;

/// A face of average form at rest that looks straight ahead: MediaPipe's canonical face model with irises in
/// the middle of the eyes, in the head's axes (FaceMotion::head), mm.
const FacePoints& canonical_face();

/// Where the canonical face is in a picture.
struct HeadFit {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< picture from head
  double scale = 1.0;                                            ///< units of the points per mm
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();         ///< of the head's origin
  double residual = 0.0;  ///< weighted root mean square of what is left, mm

  /// A point of the picture in the head's axes, mm.
  Eigen::Vector3d in_head(const Eigen::Vector3d& point) const;
};

/// The rigid motion and scale that bring the canonical face nearest to `points`, by points that move little
/// with the expression; points that do not fit count less (Cauchy weights). Points that are not finite or all
/// in one place give the identity with an infinite residual.
HeadFit fit_head(const FacePoints& points);

}  // namespace telemime
