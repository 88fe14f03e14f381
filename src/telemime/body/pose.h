// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string_view>

namespace telemime {

/// The 20 joint angles of the thesis's Table 2-1, in its order.
///
/// Body frame: x to the person's own left, y up, z forward (H-Anim); at rest the arms hang, palms inward,
/// and all joint frames are aligned with it. All angles follow the right-hand rule about these axes:
/// flexion, tilt and pivot about +x; twisting and torsion about +y; abduct, roll and wrist flexion about +z.
///
/// | angle | + moves |
/// | --- | --- |
/// | root/neck torsion | the face toward the person's left |
/// | root/neck roll | the crown toward the person's right |
/// | root/neck tilt | the face down (leaning forward) |
/// | shoulder flexion | the hanging arm backward (- is forward, up) |
/// | shoulder abduct | the hanging arm toward the person's left (left arm outward, right arm inward) |
/// | shoulder twisting | the bent forearm toward the person's left |
/// | elbow flexion | - bends the forearm forward |
/// | wrist twisting | forearm rotation, front of the hand toward the person's left |
/// | wrist pivot | the fingers backward (toward the little finger's side at rest) |
/// | wrist flexion | the fingers toward the person's left |
///
/// Composition: root, neck and shoulder R = Rz Rx Ry (thesis 2.4.2); elbow R = Rx; wrist R = Ry Rx Rz.
enum class Angle : std::size_t {
  root_torsion,
  root_roll,
  root_tilt,
  neck_roll,
  neck_torsion,
  neck_tilt,
  l_shoulder_flexion,
  l_shoulder_twisting,
  l_shoulder_abduct,
  r_shoulder_flexion,
  r_shoulder_twisting,
  r_shoulder_abduct,
  l_elbow_flexion,
  r_elbow_flexion,
  l_wrist_flexion,
  l_wrist_twisting,
  l_wrist_pivot,
  r_wrist_flexion,
  r_wrist_twisting,
  r_wrist_pivot,
};
inline constexpr std::size_t kAngleCount = 20;
inline constexpr std::size_t kPoseSize = 3 + kAngleCount;
inline constexpr std::array<std::string_view, kAngleCount> kAngleNames = {
    "root_torsion",      "root_roll",          "root_tilt",           "neck_roll",
    "neck_torsion",      "neck_tilt",          "l_shoulder_flexion",  "l_shoulder_twisting",
    "l_shoulder_abduct", "r_shoulder_flexion", "r_shoulder_twisting", "r_shoulder_abduct",
    "l_elbow_flexion",   "r_elbow_flexion",    "l_wrist_flexion",     "l_wrist_twisting",
    "l_wrist_pivot",     "r_wrist_flexion",    "r_wrist_twisting",    "r_wrist_pivot"};

using PoseVector = Eigen::Matrix<double, kPoseSize, 1>;

/// A pose: translation of the root (m, camera frame) and the 20 joint angles (rad).
struct Pose {
  Eigen::Vector3d root = Eigen::Vector3d(0.0, 0.0, 1.2);
  std::array<double, kAngleCount> angles{};

  double& operator[](Angle a) { return angles[static_cast<std::size_t>(a)]; }
  double operator[](Angle a) const { return angles[static_cast<std::size_t>(a)]; }

  /// [root translation (3), angles (20)].
  PoseVector vector() const;
  static Pose from_vector(const PoseVector& v);
};

/// The mirrored pose (plane x = 0 of the camera frame): left and right are exchanged.
Pose mirrored(const Pose& pose);

}  // namespace telemime
