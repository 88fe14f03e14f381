// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/kinematic_rates.h"

#include <gtest/gtest.h>

#include "telemime/body/testing_poses.h"

namespace telemime {
namespace {

// Central differences of forward_kinematics().
KinematicRate measured_rate(const Body& body, const Pose& pose, std::size_t number) {
  constexpr double kStep = 1e-5;
  const auto at = [&](double change) {
    PoseVector x = pose.vector();
    x[static_cast<Eigen::Index>(number)] += change;
    return forward_kinematics(body, Pose::from_vector(x));
  };
  const Kinematics less = at(-kStep);
  const Kinematics more = at(kStep);
  KinematicRate rate;
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    // The angular velocity as the antisymmetric part of R' R^T.
    const Eigen::Matrix3d a = less.camera_from_segment[s].linear();
    const Eigen::Matrix3d b = more.camera_from_segment[s].linear();
    const Eigen::Matrix3d w = (b - a) / (2 * kStep) * (0.5 * (a + b)).transpose();
    rate.angular[s] = 0.5 * Eigen::Vector3d(w(2, 1) - w(1, 2), w(0, 2) - w(2, 0), w(1, 0) - w(0, 1));
  }
  for (std::size_t j = 0; j < kJointCount; ++j) {
    rate.joints.at[j] = (more.joints.at[j] - less.joints.at[j]) / (2 * kStep);
  }
  return rate;
}

TEST(KinematicRates, AreTheDerivativesOfThePose) {
  Random random(5);
  for (const Shape& shape : {Shape{}, testing_poses::other_shape()}) {
    const Body body = make_body(shape);
    for (int i = 0; i < 50; ++i) {
      const Pose pose = testing_poses::random_pose(anatomical_limits(), random);
      const auto rates = kinematic_rates(body, pose, forward_kinematics(body, pose));
      for (std::size_t n = 0; n < kPoseSize; ++n) {
        const KinematicRate measured = measured_rate(body, pose, n);
        for (std::size_t s = 0; s < kSegmentCount; ++s) {
          EXPECT_LT((rates[n].angular[s] - measured.angular[s]).norm(), 1e-7) << n << " " << kSegmentNames[s];
        }
        for (std::size_t j = 0; j < kJointCount; ++j) {
          EXPECT_LT((rates[n].joints.at[j] - measured.joints.at[j]).norm(), 1e-7)
              << n << " " << kJointNames[j];
        }
      }
    }
  }
}

TEST(KinematicRates, ANumberMovesOnlyWhatHangsOnIt) {
  Random random(6);
  const Body body = make_body({});
  const Pose pose = testing_poses::random_pose(anatomical_limits(), random);
  const auto rates = kinematic_rates(body, pose, forward_kinematics(body, pose));
  const auto rate = [&](Angle a) -> const KinematicRate& { return rates[3 + static_cast<std::size_t>(a)]; };
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  EXPECT_EQ(rate(Angle::l_elbow_flexion).joints[Joint::l_elbow], none);
  EXPECT_EQ(rate(Angle::l_elbow_flexion).joints[Joint::r_wrist], none);
  EXPECT_NE(rate(Angle::l_elbow_flexion).joints[Joint::l_wrist], none);
  EXPECT_EQ(rate(Angle::neck_tilt).joints[Joint::l_shoulder], none);
  EXPECT_NE(rate(Angle::l_shoulder_flexion).joints[Joint::l_shoulder], none) << "the clavicle";
}

}  // namespace
}  // namespace telemime
