// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/pose.h"

namespace telemime {

PoseVector Pose::vector() const {
  PoseVector v;
  v.head<3>() = root;
  for (std::size_t i = 0; i < kAngleCount; ++i) {
    v[static_cast<Eigen::Index>(3 + i)] = angles[i];
  }
  return v;
}

Pose Pose::from_vector(const PoseVector& v) {
  Pose pose;
  pose.root = v.head<3>();
  for (std::size_t i = 0; i < kAngleCount; ++i) {
    pose.angles[i] = v[static_cast<Eigen::Index>(3 + i)];
  }
  return pose;
}

Pose mirrored(const Pose& pose) {
  // A reflection in x keeps rotations about x and turns those about y and z around.
  Pose m = pose;
  m.root.x() = -pose.root.x();
  for (const Angle a : {Angle::root_torsion, Angle::root_roll, Angle::neck_torsion, Angle::neck_roll}) {
    m[a] = -pose[a];
  }
  const auto exchange = [&](Angle left, Angle right, double sign) {
    m[left] = sign * pose[right];
    m[right] = sign * pose[left];
  };
  exchange(Angle::l_shoulder_flexion, Angle::r_shoulder_flexion, 1.0);
  exchange(Angle::l_shoulder_twisting, Angle::r_shoulder_twisting, -1.0);
  exchange(Angle::l_shoulder_abduct, Angle::r_shoulder_abduct, -1.0);
  exchange(Angle::l_elbow_flexion, Angle::r_elbow_flexion, 1.0);
  exchange(Angle::l_wrist_flexion, Angle::r_wrist_flexion, -1.0);
  exchange(Angle::l_wrist_twisting, Angle::r_wrist_twisting, -1.0);
  exchange(Angle::l_wrist_pivot, Angle::r_wrist_pivot, 1.0);
  return m;
}

}  // namespace telemime
