// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/arm_prior.h"

#include <Eigen/Cholesky>
#include <array>

#include "telemime/body/arm_parts.h"

namespace telemime {
namespace {

// Directions of one arm: upper arm, then forearm; x from the shoulder outward, y up, z the way the chest
// faces.
using ArmDirections = Eigen::Matrix<double, 6, 1>;
using ArmCovariance = Eigen::Matrix<double, 6, 6>;

constexpr std::array<double, 6> kMean = {0.28005, -0.68935, 0.11796, -0.09105, -0.14581, 0.55479};
// Lower triangles of the covariance of one arm and of that between both arms.
constexpr std::array<double, 21> kOwn = {0.10994,                                          //
                                         0.07085,  0.17708,                                //
                                         0.01195,  0.08281,  0.19042,                      //
                                         0.02877,  -0.01015, -0.07150, 0.21250,            //
                                         0.05991,  0.13449,  0.14890,  -0.06697, 0.37046,  //
                                         -0.00063, -0.02608, 0.00937,  -0.00733, 0.03562, 0.12467};
constexpr std::array<double, 21> kOther = {0.04955,                                          //
                                           0.04283,  0.07776,                                //
                                           -0.00164, 0.02691,  0.06702,                      //
                                           0.01010,  -0.00465, -0.04947, 0.07789,            //
                                           0.03223,  0.07243,  0.06426,  -0.05651, 0.19595,  //
                                           -0.00354, -0.01128, 0.01326,  -0.01446, 0.03293, 0.04717};

ArmCovariance symmetric(const std::array<double, 21>& lower) {
  ArmCovariance out;
  std::size_t at = 0;
  for (Eigen::Index r = 0; r < 6; ++r) {
    for (Eigen::Index c = 0; c <= r; ++c) {
      out(r, c) = out(c, r) = lower.at(at++);
    }
  }
  return out;
}

// Both arms have the same covariance, so that their sum and their difference are independent.
struct Whitening {
  ArmCovariance sum;
  ArmCovariance difference;
};

Whitening make_whitening() {
  const auto inverse_root = [](const ArmCovariance& covariance) -> ArmCovariance {
    return covariance.llt().matrixL().solve(ArmCovariance::Identity());
  };
  return {inverse_root(symmetric(kOwn) + symmetric(kOther)),
          inverse_root(symmetric(kOwn) - symmetric(kOther))};
}

ArmDirections directions(const Kinematics& k, Side side) {
  const ArmParts& arm = arm_parts(side);
  const Eigen::Vector3d& shoulder = k.joints[arm.shoulder];
  const Eigen::Vector3d& elbow = k.joints[arm.elbow];
  const Eigen::Vector3d& wrist = k.joints[arm.wrist];
  const auto chest = k[Segment::chest].linear();
  ArmDirections out;
  out << chest.transpose() * (elbow - shoulder).normalized(),
      chest.transpose() * (wrist - elbow).normalized();
  if (side == Side::right) {
    out[0] = -out[0];
    out[3] = -out[3];
  }
  return out;
}

}  // namespace

double arm_rarity(const Kinematics& kinematics) {
  static const Whitening whitening = make_whitening();
  const Eigen::Map<const ArmDirections> mean(kMean.data());
  const ArmDirections left = directions(kinematics, Side::left) - mean;
  const ArmDirections right = directions(kinematics, Side::right) - mean;
  return 0.5 * ((whitening.sum * (left + right)).squaredNorm() +
                (whitening.difference * (left - right)).squaredNorm());
}

}  // namespace telemime
