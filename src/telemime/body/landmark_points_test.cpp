// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/landmark_points.h"

#include <gtest/gtest.h>

#include <string>

#include "telemime/body/testing_poses.h"

namespace telemime {
namespace {

// The landmark of the other side; the nose is its own.
std::size_t other_side(std::size_t i) {
  const std::string name(kLandmarkPoints[i].name);
  if (name[1] != '_') {
    return i;
  }
  const std::string wanted = (name[0] == 'l' ? "r" : "l") + name.substr(1);
  for (std::size_t j = 0; j < kLandmarkCount; ++j) {
    if (kLandmarkPoints[j].name == wanted) {
      return j;
    }
  }
  ADD_FAILURE() << name << " has no counterpart";
  return i;
}

TEST(LandmarkPoints, MirroredPoseMirrorsThem) {
  const Body body = make_body(testing_poses::other_shape());
  const JointLimits limits = anatomical_limits();
  Random random(4);
  for (int n = 0; n < 50; ++n) {
    const Pose pose = testing_poses::random_pose(limits, random);
    const LandmarkPositions here = landmark_positions(body, forward_kinematics(body, pose));
    const LandmarkPositions there = landmark_positions(body, forward_kinematics(body, mirrored(pose)));
    for (std::size_t i = 0; i < kLandmarkCount; ++i) {
      const Eigen::Vector3d flipped(-here[i].x(), here[i].y(), here[i].z());
      EXPECT_LT((there[other_side(i)] - flipped).norm(), 1e-9) << kLandmarkPoints[i].name;
    }
  }
}

TEST(LandmarkPoints, MoveWithTheBodyAndGrowWithIt) {
  Shape tall;
  tall.stature = 2.0 * Shape{}.stature;
  const Body body = make_body({});
  const Body giant = make_body(tall);
  Pose pose;
  pose.root.setZero();
  const LandmarkPositions here = landmark_positions(body, forward_kinematics(body, pose));
  const LandmarkPositions large = landmark_positions(giant, forward_kinematics(giant, pose));
  pose.root = {0.3, -0.2, 1.0};
  const LandmarkPositions moved = landmark_positions(body, forward_kinematics(body, pose));
  for (std::size_t i = 0; i < kLandmarkCount; ++i) {
    EXPECT_LT((large[i] - 2.0 * here[i]).norm(), 1e-9) << kLandmarkPoints[i].name;
    EXPECT_LT((moved[i] - here[i] - pose.root).norm(), 1e-9) << kLandmarkPoints[i].name;
  }
}

TEST(LandmarkPoints, VelocitiesAreTheirDerivatives) {
  constexpr double kStep = 1e-5;
  const Body body = make_body(testing_poses::other_shape());
  Random random(9);
  for (int i = 0; i < 20; ++i) {
    const Pose pose = testing_poses::random_pose(anatomical_limits(), random);
    const Kinematics k = forward_kinematics(body, pose);
    const LandmarkPositions points = landmark_positions(body, k);
    const auto rates = kinematic_rates(body, pose, k);
    for (std::size_t n = 0; n < kPoseSize; ++n) {
      const auto moved = [&](double change) {
        PoseVector x = pose.vector();
        x[static_cast<Eigen::Index>(n)] += change;
        return landmark_positions(body, forward_kinematics(body, Pose::from_vector(x)));
      };
      const LandmarkPositions less = moved(-kStep);
      const LandmarkPositions more = moved(kStep);
      const LandmarkPositions velocities = landmark_velocities(points, k, rates[n]);
      for (std::size_t l = 0; l < kLandmarkCount; ++l) {
        EXPECT_LT((velocities[l] - (more[l] - less[l]) / (2 * kStep)).norm(), 1e-7)
            << n << " " << kLandmarkPoints[l].name;
      }
    }
  }
}

TEST(LandmarkPoints, BonesJoinTheirEnds) {
  const Body body = make_body({});
  const auto bones = landmark_bones(landmark_positions(body, forward_kinematics(body, Pose{})));
  const auto bone = [&](LandmarkBone b) { return bones[static_cast<std::size_t>(b)]; };
  EXPECT_GT(bone(LandmarkBone::shoulders).x(), 0.2) << "the person's left is on the right of the image";
  EXPECT_LT(bone(LandmarkBone::trunk).y(), -0.3) << "up";
  EXPECT_LT(bone(LandmarkBone::face).z(), 0.0) << "to the camera";
  EXPECT_GT(bone(LandmarkBone::l_upper_arm).y(), 0.2) << "the arms hang";
}

}  // namespace
}  // namespace telemime
