// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <string_view>

namespace telemime {

/// Joint centres of the upper body, with the names used in pose files. l_ and r_ are the person's own sides.
enum class Joint : std::size_t {
  root,      ///< HumanoidRoot of the upper body: fifth lumbar vertebra
  neck,      ///< seventh cervical vertebra
  head,      ///< skull base
  head_top,  ///< crown
  l_shoulder,
  r_shoulder,  ///< gleno-humeral centre
  l_elbow,
  r_elbow,
  l_wrist,
  r_wrist,
  l_hand,
  r_hand,  ///< middle knuckle
};
inline constexpr std::size_t kJointCount = 12;
inline constexpr std::array<std::string_view, kJointCount> kJointNames = {
    "root",    "neck",    "head",    "head_top", "l_shoulder", "r_shoulder",
    "l_elbow", "r_elbow", "l_wrist", "r_wrist",  "l_hand",     "r_hand"};

/// Positions of all joints in metres, indexed by Joint; the frame is stated where it is used.
struct JointPositions {
  std::array<Eigen::Vector3d, kJointCount> at{};
  Eigen::Vector3d& operator[](Joint j) { return at[static_cast<std::size_t>(j)]; }
  const Eigen::Vector3d& operator[](Joint j) const { return at[static_cast<std::size_t>(j)]; }
};

/// The middle between the shoulders, the reference point of errors and spreads.
inline Eigen::Vector3d mid_shoulders(const JointPositions& joints) {
  return 0.5 * (joints[Joint::l_shoulder] + joints[Joint::r_shoulder]);
}

/// Rigid segments with a surface mesh.
enum class Segment : std::size_t {
  chest,
  head,
  l_upper_arm,
  r_upper_arm,
  l_forearm,
  r_forearm,
  l_hand,
  r_hand,
};
inline constexpr std::size_t kSegmentCount = 8;
inline constexpr std::array<std::string_view, kSegmentCount> kSegmentNames = {
    "chest", "head", "l_upper_arm", "r_upper_arm", "l_forearm", "r_forearm", "l_hand", "r_hand"};

enum class Side : std::size_t { left, right };

}  // namespace telemime
