// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/body.h"

#include "telemime/body/arm_parts.h"
#include "telemime/body/rotations.h"

namespace telemime {
namespace {

// Fractions of stature. Limb lengths: de Leva (1996), joint centre to joint centre, mean of women and men.
// The shoulder's place below C7 and the skull base: from the same paper's cervicale, suprasternale and
// mid-gonion heights.
constexpr double kRootToNeck = 0.340;
constexpr double kNeckToHead = 0.062;
constexpr double kNeckToHeadForward = 0.024;
constexpr double kHeadToTop = 0.086;
constexpr double kShoulderHalfWidth = 0.105;
constexpr double kShoulderBelowNeck = 0.060;
constexpr double kShoulderForward = 0.006;
constexpr double kUpperArm = 0.160;
constexpr double kForearm = 0.149;
constexpr double kHand = 0.063;

Eigen::Matrix3d shoulder_rotation(const Pose& pose, Side side) {
  const ArmParts& arm = arm_parts(side);
  return compose_zxy({pose[arm.shoulder_abduct], pose[arm.shoulder_flexion], pose[arm.shoulder_twisting]});
}

Eigen::Isometry3d isometry(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  Eigen::Isometry3d t = Eigen::Isometry3d::Identity();
  t.linear() = rotation;
  t.translation() = translation;
  return t;
}

}  // namespace

Body make_body(const Shape& shape) {
  const double h = shape.stature;
  const SegmentScale& chest = shape[Segment::chest];
  const SegmentScale& head = shape[Segment::head];
  Body body;
  body.shape = shape;
  body.neck_from_root = {0.0, kRootToNeck * h * chest.length, 0.0};
  body.head_from_neck = {0.0, kNeckToHead * h * head.length, kNeckToHeadForward * h * head.height};
  body.head_top_from_head = {0.0, kHeadToTop * h * head.length, 0.0};
  const double half = kShoulderHalfWidth * h * chest.width * shape.shoulders;
  const double below = -kShoulderBelowNeck * h * chest.length;
  const double forward = kShoulderForward * h * chest.height;
  body.shoulder_from_neck = {Eigen::Vector3d(half, below, forward), Eigen::Vector3d(-half, below, forward)};
  body.clavicle_lift = 0.045 * h;
  body.clavicle_reach = 0.012 * h;
  body.upper_arm_length = {kUpperArm * h * shape[Segment::l_upper_arm].length,
                           kUpperArm * h * shape[Segment::r_upper_arm].length};
  body.forearm_length = {kForearm * h * shape[Segment::l_forearm].length,
                         kForearm * h * shape[Segment::r_forearm].length};
  body.hand_length = {kHand * h * shape[Segment::l_hand].length, kHand * h * shape[Segment::r_hand].length};
  return body;
}

Eigen::Matrix3d camera_from_body_at_rest() {
  return Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal();
}

Eigen::Vector3d shoulder_in_chest(const Body& body, Side side, const Eigen::Vector3d& upper_arm) {
  return body.neck_from_root + body.shoulder_from_neck[static_cast<std::size_t>(side)] +
         Eigen::Vector3d(0.0, 0.5 * body.clavicle_lift * (1.0 + upper_arm.y()),
                         body.clavicle_reach * upper_arm.z());
}

Kinematics forward_kinematics(const Body& body, const Pose& pose) {
  Kinematics k;
  const auto segment = [&](Segment s) -> Eigen::Isometry3d& {
    return k.camera_from_segment[static_cast<std::size_t>(s)];
  };
  const Eigen::Isometry3d chest =
      isometry(camera_from_body_at_rest() *
                   compose_zxy({pose[Angle::root_roll], pose[Angle::root_tilt], pose[Angle::root_torsion]}),
               pose.root);
  const Eigen::Isometry3d head =
      chest *
      isometry(compose_zxy({pose[Angle::neck_roll], pose[Angle::neck_tilt], pose[Angle::neck_torsion]}),
               body.neck_from_root);
  segment(Segment::chest) = chest;
  segment(Segment::head) = head;
  k.joints[Joint::root] = pose.root;
  k.joints[Joint::neck] = head.translation();
  k.joints[Joint::head] = head * body.head_from_neck;
  k.joints[Joint::head_top] = head * Eigen::Vector3d(body.head_from_neck + body.head_top_from_head);

  for (const Side side : {Side::left, Side::right}) {
    const auto i = static_cast<std::size_t>(side);
    const ArmParts& arm = arm_parts(side);
    const Eigen::Matrix3d shoulder = shoulder_rotation(pose, side);
    const Eigen::Isometry3d upper =
        chest * isometry(shoulder, shoulder_in_chest(body, side, -shoulder.col(1)));
    const Eigen::Isometry3d fore =
        upper * isometry(rotation_x(pose[arm.elbow_flexion]), {0.0, -body.upper_arm_length[i], 0.0});
    const Eigen::Isometry3d hand =
        fore * isometry(rotation_y(pose[arm.wrist_twisting]) * rotation_x(pose[arm.wrist_pivot]) *
                            rotation_z(pose[arm.wrist_flexion]),
                        {0.0, -body.forearm_length[i], 0.0});
    segment(arm.upper_arm) = upper;
    segment(arm.forearm) = fore;
    segment(arm.hand) = hand;
    k.joints[arm.shoulder] = upper.translation();
    k.joints[arm.elbow] = fore.translation();
    k.joints[arm.wrist] = hand.translation();
    k.joints[arm.knuckle] = hand * Eigen::Vector3d(0.0, -body.hand_length[i], 0.0);
  }
  return k;
}

}  // namespace telemime
