// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/pose.h"

#include <gtest/gtest.h>

#include <set>

#include "telemime/body/testing_poses.h"

namespace telemime {
namespace {

// 23 different numbers.
Pose counted() {
  Pose pose;
  pose.root = {0.1, 0.2, 0.3};
  for (std::size_t i = 0; i < kAngleCount; ++i) {
    pose.angles[i] = 0.01 * static_cast<double>(i + 1);
  }
  return pose;
}

TEST(Pose, VectorHoldsRootThenAnglesInOrder) {
  const PoseVector v = counted().vector();
  EXPECT_EQ(v.head<3>(), Eigen::Vector3d(0.1, 0.2, 0.3));
  EXPECT_EQ(v[3 + static_cast<Eigen::Index>(Angle::root_torsion)], 0.01);
  EXPECT_EQ(v[3 + static_cast<Eigen::Index>(Angle::r_wrist_pivot)], 0.20);
  EXPECT_EQ(Pose::from_vector(v).vector(), v);
}

TEST(Pose, NamesAreDifferentAndStandAtTheirAngle) {
  EXPECT_EQ(std::set<std::string_view>(kAngleNames.begin(), kAngleNames.end()).size(), kAngleCount);
  EXPECT_EQ(kAngleNames[static_cast<std::size_t>(Angle::root_torsion)], "root_torsion");
  EXPECT_EQ(kAngleNames[static_cast<std::size_t>(Angle::l_shoulder_abduct)], "l_shoulder_abduct");
  EXPECT_EQ(kAngleNames[static_cast<std::size_t>(Angle::r_elbow_flexion)], "r_elbow_flexion");
  EXPECT_EQ(kAngleNames[static_cast<std::size_t>(Angle::r_wrist_pivot)], "r_wrist_pivot");
}

TEST(Pose, MirroringTwiceIsNothingAndOnceIsSomething) {
  const Pose pose = counted();
  EXPECT_EQ(mirrored(mirrored(pose)).vector(), pose.vector());
  const PoseVector change = mirrored(pose).vector() - pose.vector();
  const auto tilt = [](Angle a) { return 3 + static_cast<Eigen::Index>(a); };
  for (Eigen::Index i = 0; i < change.size(); ++i) {
    // Only what lies in the mirror plane stays.
    const bool in_plane = i == 1 || i == 2 || i == tilt(Angle::root_tilt) || i == tilt(Angle::neck_tilt);
    EXPECT_EQ(change[i] == 0.0, in_plane) << i;
  }
}

}  // namespace
}  // namespace telemime
