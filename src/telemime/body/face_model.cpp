// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/face_model.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "telemime/body/face_eye.h"
#include "telemime/body/rotations.h"

namespace telemime {
namespace {

constexpr double kMesh[kFaceMeshPoints][3] = {
#include "telemime/body/face_model.inc"
};

/// The points and weights of the package's fit (procrustes_landmark_basis) without those that move with the
/// jaw and the cheeks, and with less weight on the nostrils.
constexpr std::pair<std::size_t, double> kRigid[] = {
    {4, 0.0709},   {6, 0.0321},   {10, 0.0084},  {33, 0.0587},  {54, 0.0077},  {67, 0.0091},  {117, 0.0098},
    {119, 0.0146}, {121, 0.0186}, {127, 0.0052}, {129, 0.03},   {132, 0.0056}, {133, 0.0533}, {143, 0.0148},
    {198, 0.0255}, {263, 0.0587}, {284, 0.0077}, {297, 0.0091}, {346, 0.0098}, {348, 0.0146}, {350, 0.0186},
    {356, 0.0052}, {358, 0.03},   {361, 0.0056}, {362, 0.0533}, {372, 0.0148}, {420, 0.0255}};
constexpr std::size_t kRigidCount = std::size(kRigid);

FacePoints make_canonical_face() {
  FacePoints face;
  for (std::size_t i = 0; i < kFaceMeshPoints; ++i) {
    face[i] = {kMesh[i][0], kMesh[i][1], kMesh[i][2]};
  }
  // The iris bulges a little out of the line between the corners of its eye.
  constexpr double kRadius = 5.9;  // mm
  for (const auto& [iris, outer, inner] :
       {std::array<std::size_t, 3>{kRightIris, 33, 133}, {kLeftIris, 263, 362}}) {
    const Eigen::Vector3d middle = 0.5 * (face[outer] + face[inner]) - Eigen::Vector3d(0.0, 0.0, kIrisBulge);
    face[iris] = middle;
    const Eigen::Vector3d x(kRadius, 0.0, 0.0), y(0.0, kRadius, 0.0);
    face[iris + 1] = middle + x;
    face[iris + 2] = middle - y;
    face[iris + 3] = middle - x;
    face[iris + 4] = middle + y;
  }
  return face;
}

// Least squares in closed form (Horn 1987).
HeadFit weighted_fit(const FacePoints& points, const std::array<double, kRigidCount>& weights) {
  double total = 0.0;
  Eigen::Vector3d from = Eigen::Vector3d::Zero(), to = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < kRigidCount; ++k) {
    total += weights[k];
    from += weights[k] * canonical_face()[kRigid[k].first];
    to += weights[k] * points[kRigid[k].first];
  }
  from /= total;
  to /= total;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double spread = 0.0;
  for (std::size_t k = 0; k < kRigidCount; ++k) {
    const Eigen::Vector3d own = canonical_face()[kRigid[k].first] - from;
    covariance += weights[k] * (points[kRigid[k].first] - to) * own.transpose();
    spread += weights[k] * own.squaredNorm();
  }
  HeadFit fit;
  const Eigen::Matrix3d rotation = best_rotation(covariance);
  fit.rotation = Eigen::Quaterniond(rotation).normalized();
  fit.scale = (rotation.transpose() * covariance).trace() / spread;
  fit.translation = to - fit.scale * (fit.rotation * from);
  return fit;
}

}  // namespace

const FacePoints& canonical_face() {
  static const FacePoints face = make_canonical_face();
  return face;
}

Eigen::Vector3d HeadFit::in_head(const Eigen::Vector3d& point) const {
  return rotation.conjugate() * (point - translation) / scale;
}

HeadFit fit_head(const FacePoints& points) {
  HeadFit none;
  none.residual = std::numeric_limits<double>::infinity();
  if (!std::all_of(points.begin(), points.end(), [](const Eigen::Vector3d& p) { return p.allFinite(); })) {
    return none;
  }
  std::array<double, kRigidCount> weights{};
  std::transform(std::begin(kRigid), std::end(kRigid), weights.begin(),
                 [](const auto& each) { return each.second; });
  HeadFit fit;
  constexpr int kRounds = 4;
  constexpr double kOutlier = 4.0;  // mm
  for (int round = 0; round < kRounds; ++round) {
    fit = weighted_fit(points, weights);
    constexpr double kLeastScale = 1e-9;
    if (!(fit.scale > kLeastScale) || !fit.rotation.coeffs().allFinite()) {
      return none;
    }
    double total = 0.0, sum = 0.0;
    for (std::size_t k = 0; k < kRigidCount; ++k) {
      const auto& [i, weight] = kRigid[k];
      const double square = (fit.in_head(points[i]) - canonical_face()[i]).squaredNorm();
      sum += weights[k] * square;
      total += weights[k];
      weights[k] = weight / (1.0 + square / (kOutlier * kOutlier));
    }
    fit.residual = std::sqrt(sum / total);
  }
  return fit;
}

}  // namespace telemime
