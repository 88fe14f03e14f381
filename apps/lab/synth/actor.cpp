// SPDX-License-Identifier: Apache-2.0
#include "lab/synth/actor.h"

#include <algorithm>
#include <cmath>

#include "telemime/body/arm_parts.h"

namespace telemime {
namespace {

using Eigen::AngleAxisd;
using Eigen::Matrix3d;
using Eigen::Vector3d;

// Shoulder from the neck in the chest's frame, x outward: the clavicle swings up to 20 degrees upward as the
// arm rises over the head, and up to 12 degrees forward with an arm that reaches forward.
Vector3d shoulder_from_neck(const ActorBuild& build, const Vector3d& upper) {
  const double raised = std::clamp(0.5 + 0.5 * upper.y(), 0.0, 1.0);
  const double forward = std::max(upper.z(), 0.0);
  const Vector3d at_rest(build.clavicle, -build.shoulder_drop, build.shoulder_forward);
  return AngleAxisd(0.35 * raised * raised, Vector3d::UnitZ()) *
         (AngleAxisd(-0.21 * forward, Vector3d::UnitY()) * at_rest);
}

// Axes of the hand in the chest's frame with x outward: thumb, fingers, back of the hand.
Matrix3d hand_axes(const ActorArm& arm) {
  const Vector3d fore = arm.fore.normalized();
  const Vector3d upper = arm.upper.normalized();
  // The side to which the elbow bends. A straight elbow has none: lean on the forward direction there.
  Vector3d bend = -upper + upper.dot(fore) * fore;
  bend += 0.02 * (Vector3d::UnitZ() - fore.z() * fore);
  bend.normalize();
  const Vector3d thumb = AngleAxisd(arm.pronation, fore) * bend;
  const Vector3d palm = fore.cross(thumb);
  Matrix3d axes;
  axes.col(0) = thumb;
  axes.col(1) = std::cos(arm.extension) * fore - std::sin(arm.extension) * palm;
  axes.col(2) = -(std::cos(arm.extension) * palm + std::sin(arm.extension) * fore);
  return axes;
}

}  // namespace

ActorBuild scaled_build(double height, double girth) {
  ActorBuild b;
  for (double* length :
       {&b.spine, &b.clavicle, &b.shoulder_drop, &b.shoulder_forward, &b.upper_arm, &b.forearm, &b.hand}) {
    *length *= height;
  }
  // Heads vary less than bodies.
  const double head = std::sqrt(height);
  for (double* length : {&b.neck_up, &b.neck_forward, &b.head_up}) {
    *length *= head;
  }
  b.girth = girth;
  return b;
}

ActorKinematics actor_kinematics(const ActorBuild& build, const ActorPose& pose) {
  ActorKinematics k;
  Matrix3d camera_from_body = Matrix3d::Identity();
  camera_from_body.diagonal() << 1.0, -1.0, -1.0;

  k.camera_from_chest = Eigen::Isometry3d::Identity();
  k.camera_from_chest.linear() =
      camera_from_body * (AngleAxisd(-pose.sway, Vector3d::UnitZ()) *
                          AngleAxisd(pose.lean, Vector3d::UnitX()) * AngleAxisd(pose.turn, Vector3d::UnitY()))
                             .toRotationMatrix();
  k.camera_from_chest.translation() = pose.root;
  const Vector3d neck(0.0, build.spine, 0.0);
  const Vector3d skull = neck + Vector3d(0.0, build.neck_up, build.neck_forward);

  k.camera_from_head = k.camera_from_chest;
  k.camera_from_head.translation() = k.camera_from_chest * skull;
  // A leaning speaker keeps the eyes on the other person: most of the lean is taken back by the neck.
  k.camera_from_head.linear() =
      k.camera_from_chest.linear() *
      (AngleAxisd(-pose.tilt, Vector3d::UnitZ()) * AngleAxisd(pose.nod - 0.7 * pose.lean, Vector3d::UnitX()) *
       AngleAxisd(pose.look, Vector3d::UnitY()))
          .toRotationMatrix();

  k.joints[Joint::root] = pose.root;
  k.joints[Joint::neck] = k.camera_from_chest * neck;
  k.joints[Joint::head] = k.camera_from_head.translation();
  k.joints[Joint::head_top] = k.camera_from_head * Vector3d(0.0, build.head_up, 0.008);

  for (std::size_t side = 0; side < 2; ++side) {
    const ActorArm& arm = pose.arms[side];
    Matrix3d chest_from_outward = Matrix3d::Identity();
    chest_from_outward(0, 0) = side == 0 ? 1.0 : -1.0;
    const Matrix3d turn = k.camera_from_chest.linear() * chest_from_outward;
    const Vector3d upper = arm.upper.normalized();
    const Matrix3d axes = hand_axes(arm);
    const ArmParts& parts = kArmParts[side];
    k.joints[parts.shoulder] = k.joints[Joint::neck] + turn * shoulder_from_neck(build, upper);
    k.joints[parts.elbow] = k.joints[parts.shoulder] + build.upper_arm * (turn * upper);
    k.joints[parts.wrist] = k.joints[parts.elbow] + build.forearm * (turn * arm.fore.normalized());
    k.joints[parts.knuckle] = k.joints[parts.wrist] + build.hand * (turn * axes.col(1));
    k.camera_from_hand[side] = turn * axes;
    for (std::size_t finger = 0; finger < k.curl[side].size(); ++finger) {
      k.curl[side][finger] = std::clamp(arm.curl + arm.curl_by_finger[finger], 0.0, 1.0);
    }
  }
  return k;
}

}  // namespace telemime
