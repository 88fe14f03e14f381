// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/kinematic_rates.h"

#include <cmath>

#include "telemime/body/arm_parts.h"

namespace telemime {
namespace {

using Rates = std::array<KinematicRate, kPoseSize>;

KinematicRate& rate_of(Rates& rates, Angle angle) {
  return rates[3 + static_cast<std::size_t>(angle)];
}

void turn(KinematicRate& rate, Segment segment, const Eigen::Vector3d& axis) {
  rate.angular[static_cast<std::size_t>(segment)] = axis;
}

// Moves a joint about an axis through `centre`.
void carry(KinematicRate& rate, const Kinematics& k, Joint joint, const Eigen::Vector3d& axis,
           const Eigen::Vector3d& centre) {
  rate.joints[joint] = axis.cross(k.joints[joint] - centre);
}

// x axis of a frame after a turn by `angle` about its z axis.
Eigen::Vector3d x_after_z(const Eigen::Matrix3d& frame, double angle) {
  return std::cos(angle) * frame.col(0) + std::sin(angle) * frame.col(1);
}

void add_arm(const Body& body, const Pose& pose, const Kinematics& k, Side side, Rates& rates) {
  const ArmParts& arm = arm_parts(side);
  const Eigen::Matrix3d chest = k[Segment::chest].linear();
  // Shoulder, R = Rz Rx Ry: the whole arm turns, and the clavicle follows the direction of the upper arm.
  const auto about_shoulder = [&](Angle a, const Eigen::Vector3d& axis) {
    KinematicRate& rate = rate_of(rates, a);
    const Eigen::Vector3d direction = chest.transpose() * axis.cross(-k[arm.upper_arm].linear().col(1));
    const Eigen::Vector3d shift = chest * Eigen::Vector3d(0.0, 0.5 * body.clavicle_lift * direction.y(),
                                                          body.clavicle_reach * direction.z());
    for (const Segment s : {arm.upper_arm, arm.forearm, arm.hand}) {
      turn(rate, s, axis);
    }
    for (const Joint j : {arm.shoulder, arm.elbow, arm.wrist, arm.knuckle}) {
      carry(rate, k, j, axis, k.joints[arm.shoulder]);
      rate.joints[j] += shift;
    }
  };
  about_shoulder(arm.shoulder_abduct, chest.col(2));
  about_shoulder(arm.shoulder_flexion, x_after_z(chest, pose[arm.shoulder_abduct]));
  about_shoulder(arm.shoulder_twisting, k[arm.upper_arm].linear().col(1));
  // Elbow, R = Rx.
  KinematicRate& bend = rate_of(rates, arm.elbow_flexion);
  const Eigen::Vector3d hinge = k[arm.upper_arm].linear().col(0);
  turn(bend, arm.forearm, hinge);
  turn(bend, arm.hand, hinge);
  carry(bend, k, arm.wrist, hinge, k.joints[arm.elbow]);
  carry(bend, k, arm.knuckle, hinge, k.joints[arm.elbow]);
  // Wrist, R = Ry Rx Rz.
  const auto about_wrist = [&](Angle a, const Eigen::Vector3d& axis) {
    turn(rate_of(rates, a), arm.hand, axis);
    carry(rate_of(rates, a), k, arm.knuckle, axis, k.joints[arm.wrist]);
  };
  const double twist = pose[arm.wrist_twisting];
  const Eigen::Matrix3d forearm = k[arm.forearm].linear();
  about_wrist(arm.wrist_twisting, forearm.col(1));
  about_wrist(arm.wrist_pivot, std::cos(twist) * forearm.col(0) - std::sin(twist) * forearm.col(2));
  about_wrist(arm.wrist_flexion, k[arm.hand].linear().col(2));
}

}  // namespace

Rates kinematic_rates(const Body& body, const Pose& pose, const Kinematics& k) {
  KinematicRate still;
  still.angular.fill(Eigen::Vector3d::Zero());
  still.joints.at.fill(Eigen::Vector3d::Zero());
  Rates rates;
  rates.fill(still);
  // Root: everything moves along an axis of the camera, or turns about the root (R = Rz Rx Ry).
  for (std::size_t i = 0; i < 3; ++i) {
    rates[i].joints.at.fill(Eigen::Vector3d::Unit(static_cast<Eigen::Index>(i)));
  }
  const Eigen::Matrix3d rest = camera_from_body_at_rest();
  const auto about_root = [&](Angle a, const Eigen::Vector3d& axis) {
    KinematicRate& rate = rate_of(rates, a);
    rate.angular.fill(axis);
    for (std::size_t j = 0; j < kJointCount; ++j) {
      carry(rate, k, static_cast<Joint>(j), axis, pose.root);
    }
  };
  const Eigen::Matrix3d chest = k[Segment::chest].linear();
  about_root(Angle::root_roll, rest.col(2));
  about_root(Angle::root_tilt, x_after_z(rest, pose[Angle::root_roll]));
  about_root(Angle::root_torsion, chest.col(1));
  // Neck: the head turns (R = Rz Rx Ry).
  const auto about_neck = [&](Angle a, const Eigen::Vector3d& axis) {
    turn(rate_of(rates, a), Segment::head, axis);
    carry(rate_of(rates, a), k, Joint::head, axis, k.joints[Joint::neck]);
    carry(rate_of(rates, a), k, Joint::head_top, axis, k.joints[Joint::neck]);
  };
  about_neck(Angle::neck_roll, chest.col(2));
  about_neck(Angle::neck_tilt, x_after_z(chest, pose[Angle::neck_roll]));
  about_neck(Angle::neck_torsion, k[Segment::head].linear().col(1));
  for (const Side side : {Side::left, Side::right}) {
    add_arm(body, pose, k, side, rates);
  }
  return rates;
}

}  // namespace telemime
