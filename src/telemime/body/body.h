// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>

#include "telemime/body/pose.h"
#include "telemime/body/shape.h"
#include "telemime/body/skeleton.h"

namespace telemime {

/// The articulated model of a person: rest offsets between the joints (m, body frame) for a shape. Constant;
/// build it once per shape.
struct Body {
  Shape shape;
  Eigen::Vector3d neck_from_root;
  Eigen::Vector3d head_from_neck;
  Eigen::Vector3d head_top_from_head;
  std::array<Eigen::Vector3d, 2> shoulder_from_neck;  ///< by Side
  double clavicle_lift = 0.0;                         ///< m by which a raised upper arm lifts its shoulder
  double clavicle_reach = 0.0;                        ///< m by which a forward arm moves its shoulder
  std::array<double, 2> upper_arm_length{};           ///< m
  std::array<double, 2> forearm_length{};
  std::array<double, 2> hand_length{};  ///< wrist to middle knuckle
};

/// Joint offsets from anthropometric proportions (de Leva, J. Biomechanics 29, 1996, Tables 2 and 4: mean of
/// women and men, as fractions of stature) and the shape's scales.
Body make_body(const Shape& shape);

/// All segments as camera_from_segment. The frame of a segment is the body frame at rest with its origin in
/// the segment's joint (chest: root; head: neck; upper arm: shoulder; forearm: elbow; hand: wrist).
struct Kinematics {
  std::array<Eigen::Isometry3d, kSegmentCount> camera_from_segment;
  JointPositions joints;  ///< m, camera frame
  const Eigen::Isometry3d& operator[](Segment s) const {
    return camera_from_segment[static_cast<std::size_t>(s)];
  }
};

/// The gleno-humeral centre (m, chest frame) for an upper arm that points along this unit vector (chest
/// frame). It moves with the clavicle: scapulo-humeral rhythm (Inman, Saunders & Abbott, J. Bone Joint Surg.
/// 26, 1944), linear in the arm's direction.
Eigen::Vector3d shoulder_in_chest(const Body& body, Side side, const Eigen::Vector3d& upper_arm);

/// Forward kinematics (thesis 2.4.2, equations 2.1 and 2.2).
Kinematics forward_kinematics(const Body& body, const Pose& pose);

/// A person facing the camera: x of the body is x of the camera, y and z are opposite.
Eigen::Matrix3d camera_from_body_at_rest();

}  // namespace telemime
