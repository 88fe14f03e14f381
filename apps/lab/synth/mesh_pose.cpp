// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "lab/synth/mesh_person.h"
#include "telemime/body/arm_parts.h"
#include "telemime/body/rotations.h"

namespace telemime {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

// The turn of each part of the body: from the rest pose to the camera's frame.
struct ArmTurns {
  Quaterniond swing;  // of the upper arm without its twist
  Quaterniond upper, fore, hand;
  double twist = 0.0;                            // rad, of the hand against the forearm, about the forearm
  Vector3d along{0.0, 0.0, 0.0};                 // the forearm, length 1
  std::array<Vector3d, kHandJointCount> joints;  // of the actor's hand, camera frame; only differences count
};

double angle_about(const Vector3d& axis, const Vector3d& from, const Vector3d& to) {
  return std::atan2(from.cross(to).dot(axis), from.dot(to));
}

// The axes that the knuckles span: to the thumb, along the fingers, out of the back (either hand).
Matrix3d hand_axes(const std::array<Vector3d, kHandJointCount>& h, std::size_t side) {
  const std::size_t index = hand_joint(1, 0);
  const std::size_t middle = hand_joint(2, 0);
  const std::size_t little = hand_joint(4, 0);
  Matrix3d axes;
  axes.col(1) = (h[middle] - h[0]).normalized();
  const Vector3d across = h[index] - h[little];
  axes.col(0) = (across - across.dot(axes.col(1)) * axes.col(1)).normalized();
  axes.col(2) = (side == 0 ? 1.0 : -1.0) * axes.col(0).cross(axes.col(1));
  return axes;
}

class Poser {
 public:
  Poser(const MeshPerson& person, const ActorKinematics& actor) : person_(person), actor_(actor) {
    for (std::size_t i = 0; i < person.bones.size(); ++i) {
      index_.emplace(person.bones[i].name, i);
    }
    chest_ = Quaterniond(actor.camera_from_chest.linear());
    head_ = Quaterniond(actor.camera_from_head.linear());
    for (std::size_t side = 0; side < 2; ++side) {
      arms_[side] = turns_of_arm(side);
    }
  }

  PersonTruth truth() const {
    const Bones bones = turned();
    return truth(bones);
  }

  PosedMesh pose() const {
    const Bones bones = turned();
    PosedMesh posed{.vertices = {}, .truth = truth(bones)};
    for (const MeshPart& part : person_.parts) {
      posed.vertices.push_back(skin(part, bones));
    }
    return posed;
  }

 private:
  // Turn and head of each bone.
  struct Bones {
    std::vector<Quaterniond> turns;
    std::vector<Vector3d> heads;
  };

  // Every bone carries those that hang on it.
  Bones turned() const {
    const std::size_t count = person_.bones.size();
    Bones bones{std::vector<Quaterniond>(count), std::vector<Vector3d>(count)};
    const std::vector<bool> head = bones_of_head(person_.bones);
    for (std::size_t i = 0; i < count; ++i) {
      const MeshBone& bone = person_.bones[i];
      const auto parent = static_cast<std::size_t>(std::max(bone.parent, 0));
      bones.turns[i] = head[i] ? head_ : turn_of(bone.name);
      const Vector3d at_rest = bone.head.cast<double>();
      const Vector3d from_parent = at_rest - person_.bones[parent].head.cast<double>();
      bones.heads[i] =
          bone.parent < 0 ? at_rest : Vector3d(bones.heads[parent] + bones.turns[parent] * from_parent);
    }
    const Vector3d shoulders = 0.5 * (bones.heads[bone("upperarm01.L")] + bones.heads[bone("upperarm01.R")]);
    const Vector3d shift = mid_shoulders(actor_.joints) - shoulders;
    for (Vector3d& place : bones.heads) {
      place += shift;
    }
    return bones;
  }

  std::size_t bone(const std::string& name) const { return index_.at(name); }
  Vector3d rest(const std::string& name) const { return person_.bones[bone(name)].head.cast<double>(); }
  Vector3d rest_tail(const std::string& name) const { return person_.bones[bone(name)].tail.cast<double>(); }
  static std::string sided(const std::string& name, std::size_t side) {
    return name + (side == 0 ? ".L" : ".R");
  }
  static std::string phalanx(std::size_t finger, std::size_t point, std::size_t side) {
    return sided("finger" + std::to_string(finger + 1) + "-" + std::to_string(point + 1), side);
  }

  // The bone whose head is a joint of the hand; of a finger's tip, the bone that ends there.
  std::string hand_bone(std::size_t joint, std::size_t side) const {
    if (joint == 0) {
      return sided("wrist", side);
    }
    return phalanx((joint - 1) / 4, std::min<std::size_t>((joint - 1) % 4, 2), side);
  }
  static bool is_tip(std::size_t joint) { return joint > 0 && joint % 4 == 0; }

  std::array<Vector3d, kHandJointCount> rest_hand(std::size_t side) const {
    std::array<Vector3d, kHandJointCount> h;
    for (std::size_t j = 0; j < h.size(); ++j) {
      h[j] = is_tip(j) ? rest_tail(hand_bone(j, side)) : rest(hand_bone(j, side));
    }
    return h;
  }

  ArmTurns turns_of_arm(std::size_t side) const {
    const Vector3d shoulder = actor_.joints[kArmParts[side].shoulder];
    const Vector3d elbow = actor_.joints[kArmParts[side].elbow];
    const Vector3d wrist = actor_.joints[kArmParts[side].wrist];
    const Vector3d upper = (elbow - shoulder).normalized();
    const Vector3d rest_upper = rest(sided("lowerarm01", side)) - rest(sided("upperarm01", side));
    const Vector3d rest_fore = rest(sided("wrist", side)) - rest(sided("lowerarm01", side));
    ArmTurns arm;
    arm.along = (wrist - elbow).normalized();
    arm.swing = rotation_between(chest_ * rest_upper, upper) * chest_;
    // The elbow's axis decides about the twist of the upper arm; a straight elbow has none.
    const Vector3d axis = upper.cross(arm.along);
    const Vector3d rest_axis = (arm.swing * rest_upper.cross(rest_fore)).normalized();
    const double twist = angle_about(upper, rest_axis, axis) * std::min(1.0, axis.norm() / 0.3);
    arm.upper = Eigen::AngleAxisd(twist, upper) * arm.swing;
    arm.fore = rotation_between(arm.upper * rest_fore, arm.along) * arm.upper;

    const auto shape = hand_joints(hand_shape(actor_.curl[side]));
    for (std::size_t j = 0; j < arm.joints.size(); ++j) {
      arm.joints[j] = actor_.camera_from_hand[side] * shape[j].cast<double>();
    }
    arm.hand =
        Quaterniond(Matrix3d(hand_axes(arm.joints, side) * hand_axes(rest_hand(side), side).transpose()));
    const Quaterniond turn = arm.hand * arm.fore.conjugate();
    arm.twist = 2.0 * std::atan2(turn.vec().dot(arm.along), turn.w());
    arm.twist = std::remainder(arm.twist, 2.0 * M_PI);
    return arm;
  }

  Quaterniond turn_of(const std::string& name) const {
    const std::string_view n = name;
    if (n.starts_with("neck0")) {
      const double share = n == "neck01" ? 0.2 : n == "neck02" ? 0.5 : 0.8;
      return chest_.slerp(share, head_);
    }
    if (!n.ends_with(".L") && !n.ends_with(".R")) {
      return chest_;
    }
    const std::size_t side = n.ends_with(".L") ? 0 : 1;
    const ArmTurns& arm = arms_[side];
    const auto twisted = [&](double share) {
      return Quaterniond(Eigen::AngleAxisd(share * arm.twist, arm.along) * arm.fore);
    };
    if (n.starts_with("clavicle")) {
      return chest_.slerp(0.12, arm.swing);
    }
    if (n.starts_with("shoulder01")) {
      return chest_.slerp(0.3, arm.swing);
    }
    if (n.starts_with("upperarm01")) {
      return arm.swing.slerp(0.5, arm.upper);
    }
    if (n.starts_with("upperarm02")) {
      return arm.upper;
    }
    if (n.starts_with("lowerarm01")) {
      return twisted(0.25);
    }
    if (n.starts_with("lowerarm02")) {
      return twisted(0.65);
    }
    if (n.starts_with("wrist") || n.starts_with("metacarpal")) {
      return arm.hand;
    }
    if (n.starts_with("finger")) {
      const auto finger = static_cast<std::size_t>(n[6] - '1');
      const std::size_t from = hand_joint(finger, static_cast<std::size_t>(n[8] - '1'));
      const MeshBone& at_rest = person_.bones[bone(name)];
      const Vector3d along = (at_rest.tail - at_rest.head).cast<double>();
      return rotation_between(arm.hand * along, arm.joints[from + 1] - arm.joints[from]) * arm.hand;
    }
    return chest_;
  }

  PersonTruth truth(const Bones& bones) const {
    const auto head_of = [&](const std::string& name) { return bones.heads[bone(name)]; };
    const auto tail_of = [&](const std::string& name) {
      const std::size_t i = bone(name);
      return Vector3d(bones.heads[i] + bones.turns[i] * (rest_tail(name) - rest(name)));
    };
    PersonTruth truth{actor_, {points_at_origin(), points_at_origin()}};
    JointPositions& joints = truth.bones.joints;
    joints[Joint::root] = head_of("spine04");
    joints[Joint::neck] = head_of("neck01");
    joints[Joint::head] = head_of("head");
    joints[Joint::head_top] = tail_of("head");
    truth.bones.camera_from_chest.translation() = joints[Joint::root];
    truth.bones.camera_from_head.translation() = joints[Joint::head];
    truth.bones.camera_from_head.linear() = head_.toRotationMatrix() * person_.rest_from_face.cast<double>();
    for (std::size_t side = 0; side < 2; ++side) {
      for (std::size_t j = 0; j < kHandJointCount; ++j) {
        truth.hands[side][j] = is_tip(j) ? tail_of(hand_bone(j, side)) : head_of(hand_bone(j, side));
      }
      // The thumb of the meshes starts farther from the wrist than that of people (docs/synth.md).
      constexpr double kThumbToWrist = 0.35;
      Vector3d& thumb = truth.hands[side][hand_joint(0, 0)];
      thumb += kThumbToWrist * (truth.hands[side][0] - thumb);
      const ArmParts& arm = kArmParts[side];
      joints[arm.shoulder] = head_of(sided("upperarm01", side));
      joints[arm.elbow] = head_of(sided("lowerarm01", side));
      joints[arm.wrist] = truth.hands[side][0];
      joints[arm.knuckle] = truth.hands[side][hand_joint(2, 0)];
    }
    return truth;
  }

  std::vector<Eigen::Vector3f> skin(const MeshPart& part, const Bones& bones) const {
    std::vector<Eigen::Matrix<float, 3, 4>> motions(bones.turns.size());
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const Matrix3d turn = bones.turns[i].toRotationMatrix();
      motions[i].leftCols<3>() = turn.cast<float>();
      motions[i].col(3) = (bones.heads[i] - turn * person_.bones[i].head.cast<double>()).cast<float>();
    }
    std::vector<Eigen::Vector3f> moved(part.vertices.size());
    for (std::size_t v = 0; v < moved.size(); ++v) {
      Eigen::Matrix<float, 3, 4> blend = Eigen::Matrix<float, 3, 4>::Zero();
      for (std::size_t k = 0; k < 4; ++k) {
        blend += part.weights[v][static_cast<Eigen::Index>(k)] *
                 motions[static_cast<std::size_t>(part.bones[v][k])];
      }
      moved[v] = blend * part.vertices[v].homogeneous();
    }
    return moved;
  }

  const MeshPerson& person_;
  const ActorKinematics& actor_;
  std::map<std::string, std::size_t> index_;
  Quaterniond chest_, head_;
  std::array<ArmTurns, 2> arms_;
};

}  // namespace

PersonTruth mesh_truth(const MeshPerson& person, const ActorKinematics& actor) {
  return Poser(person, actor).truth();
}

PosedMesh pose_mesh(const MeshPerson& person, const ActorKinematics& actor) {
  return Poser(person, actor).pose();
}

}  // namespace telemime
