// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/bvh/skeleton.h"

#include <algorithm>
#include <cmath>

#include "telemime/body/arm_parts.h"
#include "telemime/body/rotations.h"
#include "telemime/outputs/humanoid.h"
#include "telemime/outputs/t_pose.h"

namespace telemime {
namespace {

constexpr double kCentimetresPerMetre = 100.0;

constexpr LegProportions kLegs;
// The height of the clavicle's outer end above the shoulder centre, of stature.
constexpr double kBlade = 0.030;

/// Clavicle and shoulder blade: two links in the chest frame, m.
struct Girdle {
  Eigen::Vector3d collar;    ///< inner end of the clavicle
  Eigen::Vector3d blade;     ///< outer end of the clavicle
  Eigen::Vector3d shoulder;  ///< shoulder centre
};

/// Direction in the plane of `along` and the vertical, perpendicular to `along`, upward.
Eigen::Vector3d upward(const Eigen::Vector3d& along) {
  const Eigen::Vector3d axis = along.normalized();
  return (Eigen::Vector3d::UnitY() - axis.y() * axis).normalized();
}

Girdle girdle_in_t_pose(const Body& body, Side side) {
  Girdle girdle;
  girdle.collar = collar_in_chest(body, side);
  girdle.shoulder = shoulder_in_chest(body, side, side_sign(side) * Eigen::Vector3d::UnitX());
  girdle.blade = girdle.shoulder + kBlade * body.shape.stature * upward(girdle.shoulder - girdle.collar);
  return girdle;
}

/// The same links with the shoulder elsewhere: the triangle of the three points from its three sides.
Girdle girdle_reaching(const Girdle& rest, const Eigen::Vector3d& shoulder) {
  const double clavicle = (rest.blade - rest.collar).norm();
  const double blade = (rest.shoulder - rest.blade).norm();
  const Eigen::Vector3d reach = shoulder - rest.collar;
  const double distance = reach.norm();
  const double along = (distance * distance + clavicle * clavicle - blade * blade) / (2.0 * distance);
  const double height = std::sqrt(std::max(0.0, clavicle * clavicle - along * along));
  return {rest.collar, rest.collar + along * reach / distance + height * upward(reach), shoulder};
}

/// Axes along a link and across the plane of the girdle.
Eigen::Matrix3d link_frame(const Eigen::Vector3d& link, const Girdle& girdle) {
  Eigen::Matrix3d frame;
  const Eigen::Vector3d reach = girdle.shoulder - girdle.collar;
  frame.col(0) = link.normalized();
  frame.col(1) = reach.cross(upward(reach)).normalized();
  frame.col(2) = frame.col(0).cross(frame.col(1));
  return frame;
}

BvhJoint joint(const std::string& name, BvhBone parent, const Eigen::Vector3d& metres) {
  BvhJoint result;
  result.name = name;
  result.parent = static_cast<int>(parent);
  result.offset = kCentimetresPerMetre * metres;
  return result;
}

BvhJoint last_joint(const char* name, BvhBone parent, const Eigen::Vector3d& metres,
                    const Eigen::Vector3d& end_metres) {
  BvhJoint result = joint(name, parent, metres);
  result.end_site = kCentimetresPerMetre * end_metres;
  return result;
}

void add_arm(const Body& body, Side side, std::vector<BvhJoint>& joints) {
  const bool left = side == Side::left;
  const auto i = static_cast<std::size_t>(side);
  const Eigen::Vector3d outward = side_sign(side) * Eigen::Vector3d::UnitX();
  const Girdle girdle = girdle_in_t_pose(body, side);
  const Eigen::Vector3d spine1 = 0.5 * body.neck_from_root;
  joints.push_back(joint(left ? "LeftShoulder" : "RightShoulder", BvhBone::spine1, girdle.collar - spine1));
  joints.push_back(joint(left ? "LeftShoulderBlade" : "RightShoulderBlade",
                         left ? BvhBone::l_collar : BvhBone::r_collar, girdle.blade - girdle.collar));
  joints.push_back(joint(left ? "LeftArm" : "RightArm", left ? BvhBone::l_blade : BvhBone::r_blade,
                         girdle.shoulder - girdle.blade));
  joints.push_back(joint(left ? "LeftForeArm" : "RightForeArm", left ? BvhBone::l_arm : BvhBone::r_arm,
                         body.upper_arm_length[i] * outward));
  joints.push_back(last_joint(left ? "LeftHand" : "RightHand", left ? BvhBone::l_forearm : BvhBone::r_forearm,
                              body.forearm_length[i] * outward, body.hand_length[i] * outward));
}

void add_leg(const Body& body, Side side, std::vector<BvhJoint>& joints) {
  const bool left = side == Side::left;
  const double h = body.shape.stature;
  joints.push_back(joint(left ? "LeftUpLeg" : "RightUpLeg", BvhBone::hips,
                         {side_sign(side) * kLegs.hip_half_width * h, 0, 0}));
  joints.push_back(joint(left ? "LeftLeg" : "RightLeg", left ? BvhBone::l_thigh : BvhBone::r_thigh,
                         {0, -kLegs.thigh * h, 0}));
  joints.push_back(last_joint(left ? "LeftFoot" : "RightFoot", left ? BvhBone::l_shank : BvhBone::r_shank,
                              {0, -kLegs.shank * h, 0}, {0, -kLegs.ankle_height * h, kLegs.foot_length * h}));
}

void add_fingers(const FingerSkeleton& fingers, std::vector<BvhJoint>& joints) {
  for (const BvhBone hand : {BvhBone::l_hand, BvhBone::r_hand}) {
    joints[static_cast<std::size_t>(hand)].end_site.reset();
  }
  for (std::size_t b = 0; b < kFingerBoneCount; ++b) {
    const BvhBone hand = side_of_finger_bone(b) == Side::left ? BvhBone::l_hand : BvhBone::r_hand;
    BvhJoint bone = joint(motion_builder_name(b), hand, fingers.offset(b));
    if (b % 3 != 0) {
      bone.parent = static_cast<int>(joints.size()) - 1;
    }
    if (b % 3 == 2) {
      bone.end_site = kCentimetresPerMetre * (fingers.end[b] - fingers.position[b]);
    }
    joints.push_back(bone);
  }
}

Eigen::Vector3d spine_from_hips(const Body& body) {
  return {0.0, kLegs.hips_below_root * body.shape.stature, 0.0};
}

}  // namespace

std::vector<BvhJoint> bvh_skeleton(const Body& body, const std::optional<FingerSkeleton>& fingers) {
  std::vector<BvhJoint> joints;
  BvhJoint hips = joint("Hips", BvhBone::hips, Eigen::Vector3d::Zero());
  hips.parent = -1;
  joints.push_back(hips);
  joints.push_back(joint("Spine", BvhBone::hips, spine_from_hips(body)));
  joints.push_back(joint("Spine1", BvhBone::spine, 0.5 * body.neck_from_root));
  joints.push_back(joint("Neck", BvhBone::spine1, 0.5 * body.neck_from_root));
  joints.push_back(last_joint("Head", BvhBone::neck, body.head_from_neck, body.head_top_from_head));
  add_arm(body, Side::left, joints);
  add_arm(body, Side::right, joints);
  add_leg(body, Side::left, joints);
  add_leg(body, Side::right, joints);
  if (fingers) {
    add_fingers(*fingers, joints);
  }
  return joints;
}

BvhMotion bvh_motion(const Body& body, const Pose& pose) {
  const Kinematics k = forward_kinematics(body, pose);
  const Eigen::Matrix3d world_from_camera = camera_from_body_at_rest().transpose();
  const Eigen::Matrix3d trunk = world_from_camera * k[Segment::chest].linear();
  const Eigen::Matrix3d hips = rotation_y(heading(trunk));
  BvhMotion motion;
  motion.parent_from_bone.fill(Eigen::Matrix3d::Identity());
  const auto set = [&motion](BvhBone bone, const Eigen::Matrix3d& rotation) {
    motion.parent_from_bone[static_cast<std::size_t>(bone)] = rotation;
  };
  motion.hips = kCentimetresPerMetre * (world_from_camera * pose.root - hips * spine_from_hips(body));
  set(BvhBone::hips, hips);
  set(BvhBone::spine, hips.transpose() * trunk);
  set(BvhBone::neck, k[Segment::chest].linear().transpose() * k[Segment::head].linear());

  for (const Side side : {Side::left, Side::right}) {
    const bool left = side == Side::left;
    const ArmParts& arm = arm_parts(side);
    const Eigen::Isometry3d& upper = k[arm.upper_arm];
    const Eigen::Isometry3d& fore = k[arm.forearm];
    const Eigen::Isometry3d& hand = k[arm.hand];
    const Eigen::Isometry3d arm_in_chest = k[Segment::chest].inverse() * upper;
    const Girdle rest = girdle_in_t_pose(body, side);
    const Girdle girdle = girdle_reaching(rest, arm_in_chest.translation());
    const Eigen::Matrix3d clavicle = link_frame(girdle.blade - girdle.collar, girdle) *
                                     link_frame(rest.blade - rest.collar, rest).transpose();
    const Eigen::Matrix3d blade = link_frame(girdle.shoulder - girdle.blade, girdle) *
                                  link_frame(rest.shoulder - rest.blade, rest).transpose();
    const Eigen::Matrix3d t = t_pose_from_rest(side);
    set(left ? BvhBone::l_collar : BvhBone::r_collar, clavicle);
    set(left ? BvhBone::l_blade : BvhBone::r_blade, clavicle.transpose() * blade);
    set(left ? BvhBone::l_arm : BvhBone::r_arm, blade.transpose() * arm_in_chest.linear() * t.transpose());
    set(left ? BvhBone::l_forearm : BvhBone::r_forearm,
        t * upper.linear().transpose() * fore.linear() * t.transpose());
    set(left ? BvhBone::l_hand : BvhBone::r_hand,
        t * fore.linear().transpose() * hand.linear() * t.transpose());
  }
  return motion;
}

void turn_head(const FaceMotion& face, BvhMotion& motion) {
  const auto at = [&motion](BvhBone bone) -> Eigen::Matrix3d& {
    return motion.parent_from_bone[static_cast<std::size_t>(bone)];
  };
  const Eigen::Matrix3d chest = at(BvhBone::hips) * at(BvhBone::spine) * at(BvhBone::spine1);
  const NeckAndHead turned =
      neck_and_head(face, Eigen::Quaterniond(chest),
                    {Eigen::Quaterniond(at(BvhBone::neck)), Eigen::Quaterniond(at(BvhBone::head))});
  at(BvhBone::neck) = turned.neck.toRotationMatrix();
  at(BvhBone::head) = turned.head.toRotationMatrix();
}

}  // namespace telemime
