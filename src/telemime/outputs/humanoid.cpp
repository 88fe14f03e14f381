// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/humanoid.h"

#include <algorithm>

#include "telemime/body/arm_parts.h"
#include "telemime/body/rotations.h"
#include "telemime/outputs/t_pose.h"

namespace telemime {
namespace {

constexpr LegProportions kLegs;

std::size_t at(HumanBone bone) {
  return static_cast<std::size_t>(bone);
}

// The bones of one side.
struct SideBones {
  HumanBone shoulder, upper_arm, lower_arm, hand, upper_leg, lower_leg, foot;
};

SideBones bones_of(Side side) {
  using enum HumanBone;
  return side == Side::left
             ? SideBones{l_shoulder, l_upper_arm, l_lower_arm, l_hand, l_upper_leg, l_lower_leg, l_foot}
             : SideBones{r_shoulder, r_upper_arm, r_lower_arm, r_hand, r_upper_leg, r_lower_leg, r_foot};
}

Eigen::Quaterniond quaternion(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0.0) {
    q.coeffs() = -q.coeffs();
  }
  return q.normalized();
}

Eigen::Vector3d root_of(const Body& body) {
  const double h = body.shape.stature;
  return {0.0, (kLegs.ankle_height + kLegs.shank + kLegs.thigh + kLegs.hips_below_root) * h, 0.0};
}

void add_side(const Body& body, Side side, HumanoidSkeleton& s) {
  const auto i = static_cast<std::size_t>(side);
  const SideBones bones = bones_of(side);
  const Eigen::Vector3d outward = side_sign(side) * Eigen::Vector3d::UnitX();
  const Eigen::Vector3d down = -body.shape.stature * Eigen::Vector3d::UnitY();
  const auto put = [&s](HumanBone bone, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    s.position[at(bone)] = from;
    s.end[at(bone)] = to;
  };
  const Eigen::Vector3d root = root_of(body);
  const Eigen::Vector3d collar = root + collar_in_chest(body, side);
  const Eigen::Vector3d shoulder = root + shoulder_in_chest(body, side, outward);
  const Eigen::Vector3d elbow = shoulder + body.upper_arm_length[i] * outward;
  const Eigen::Vector3d wrist = elbow + body.forearm_length[i] * outward;
  put(bones.shoulder, collar, shoulder);
  put(bones.upper_arm, shoulder, elbow);
  put(bones.lower_arm, elbow, wrist);
  put(bones.hand, wrist, wrist + body.hand_length[i] * outward);

  const Eigen::Vector3d hip =
      s.position[at(HumanBone::hips)] + kLegs.hip_half_width * body.shape.stature * outward;
  const Eigen::Vector3d knee = hip + kLegs.thigh * down;
  const Eigen::Vector3d ankle = knee + kLegs.shank * down;
  const Eigen::Vector3d toes =
      ankle + kLegs.ankle_height * down + kLegs.foot_length * body.shape.stature * Eigen::Vector3d::UnitZ();
  put(bones.upper_leg, hip, knee);
  put(bones.lower_leg, knee, ankle);
  put(bones.foot, ankle, toes);
}

}  // namespace

Eigen::Vector3d HumanoidSkeleton::offset(HumanBone bone) const {
  const int parent = kHumanBoneParent[at(bone)];
  return parent < 0 ? position[at(bone)] : position[at(bone)] - position[static_cast<std::size_t>(parent)];
}

HumanoidSkeleton humanoid_skeleton(const Body& body) {
  HumanoidSkeleton s;
  const Eigen::Vector3d root = root_of(body);
  const Eigen::Vector3d c7 = root + body.neck_from_root;
  const std::array<Eigen::Vector3d, 6> trunk = {
      root - kLegs.hips_below_root * body.shape.stature * Eigen::Vector3d::UnitY(),
      root,
      root + 0.5 * body.neck_from_root,
      c7,
      c7 + body.head_from_neck,
      c7 + body.head_from_neck + body.head_top_from_head};
  for (std::size_t i = 0; i + 1 < trunk.size(); ++i) {  // hips, spine, chest, neck, head
    s.position[i] = trunk[i];
    s.end[i] = trunk[i + 1];
  }
  add_side(body, Side::left, s);
  add_side(body, Side::right, s);
  const HandSizes hand = average_hand(body.shape.stature);
  s.fingers = finger_skeleton(hand, hand);
  return s;
}

HumanoidMotion humanoid_motion(const Body& body, const Pose& pose, const Eigen::Vector3d& origin) {
  using enum HumanBone;
  const Kinematics k = forward_kinematics(body, pose);
  const Eigen::Matrix3d world_from_camera = camera_from_body_at_rest().transpose();
  const Eigen::Matrix3d trunk = world_from_camera * k[Segment::chest].linear();
  const Eigen::Matrix3d turned = rotation_y(heading(trunk));
  HumanoidMotion motion;
  motion.rotation.fill(Eigen::Quaterniond::Identity());
  const auto set = [&motion](HumanBone bone, const Eigen::Matrix3d& rotation) {
    motion.rotation[at(bone)] = quaternion(rotation);
  };
  motion.hips = root_of(body) - kLegs.hips_below_root * body.shape.stature * Eigen::Vector3d::UnitY() +
                world_from_camera * (pose.root - origin);
  set(hips, turned);
  set(spine, turned.transpose() * trunk);
  set(neck, k[Segment::chest].linear().transpose() * k[Segment::head].linear());

  for (const Side side : {Side::left, Side::right}) {
    const ArmParts& parts = arm_parts(side);
    const SideBones bones = bones_of(side);
    const Eigen::Isometry3d arm = k[Segment::chest].inverse() * k[parts.upper_arm];
    const Eigen::Matrix3d fore_in_arm = rotation_x(pose[parts.elbow_flexion]);
    const Eigen::Matrix3d half_twist = rotation_y(0.5 * pose[parts.wrist_twisting]);
    const Eigen::Matrix3d hand_in_fore = k[parts.forearm].linear().transpose() * k[parts.hand].linear();
    const Eigen::Vector3d collar = collar_in_chest(body, side);
    const Eigen::Vector3d at_rest = shoulder_in_chest(body, side, side_sign(side) * Eigen::Vector3d::UnitX());
    const Eigen::Matrix3d clavicle =
        rotation_between(at_rest - collar, arm.translation() - collar).toRotationMatrix();
    const Eigen::Matrix3d t = t_pose_from_rest(side);
    const auto in_t_pose = [&t](const Eigen::Matrix3d& rotation) -> Eigen::Matrix3d {
      return t * rotation * t.transpose();
    };
    set(bones.shoulder, clavicle);
    set(bones.upper_arm, clavicle.transpose() * arm.linear() * t.transpose());
    set(bones.lower_arm, in_t_pose(fore_in_arm * half_twist));
    set(bones.hand, in_t_pose(half_twist.transpose() * hand_in_fore));
  }
  return motion;
}

NeckAndHead neck_and_head(const FaceMotion& face, const Eigen::Quaterniond& world_from_chest,
                          const NeckAndHead& unseen) {
  const Eigen::Quaterniond world_from_camera(Eigen::Matrix3d(camera_from_body_at_rest().transpose()));
  const Eigen::Quaterniond held = world_from_camera * face.head * world_from_camera.conjugate();
  const auto upright = [](Eigen::Quaterniond q) {
    if (q.w() < 0.0) {
      q.coeffs() = -q.coeffs();
    }
    return q.normalized();
  };
  // The neck does not turn farther than this.
  constexpr double kFarthest = 1.4;  // rad
  Eigen::AngleAxisd turn(upright(world_from_chest.conjugate() * held));
  turn.angle() = std::min(turn.angle(), kFarthest);
  const Eigen::Quaterniond half(Eigen::AngleAxisd(0.5 * turn.angle(), turn.axis()));
  const double seen = std::clamp(face.confidence, 0.0, 1.0);
  return {upright(unseen.neck.slerp(seen, half)), upright(unseen.head.slerp(seen, half))};
}

void turn_head(const FaceMotion& face, HumanoidMotion& motion) {
  using enum HumanBone;
  const auto [turned_neck, turned_head] = neck_and_head(
      face, motion[hips] * motion[spine] * motion[HumanBone::chest], {motion[neck], motion[HumanBone::head]});
  motion.rotation[at(neck)] = turned_neck;
  motion.rotation[at(HumanBone::head)] = turned_head;
}

HumanoidMotion humanoid_motion(const Body& body, const MotionFrame& frame, const Eigen::Vector3d& origin) {
  if (!frame.hands) {
    return humanoid_motion(body, frame.pose, origin);
  }
  HumanoidMotion motion = humanoid_motion(body, with_wrists(frame.pose, *frame.hands), origin);
  motion.fingers = finger_bone_rotations(*frame.hands);
  return motion;
}

std::array<Eigen::Vector3d, kHumanBoneCount> humanoid_joints(const HumanoidSkeleton& skeleton,
                                                             const HumanoidMotion& motion) {
  std::array<Eigen::Vector3d, kHumanBoneCount> joints;
  std::array<Eigen::Quaterniond, kHumanBoneCount> world;
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    if (kHumanBoneParent[b] < 0) {
      joints[b] = motion.hips;
      world[b] = motion.rotation[b];
      continue;
    }
    const auto parent = static_cast<std::size_t>(kHumanBoneParent[b]);  // parents come first
    joints[b] = joints[parent] + world[parent] * skeleton.offset(static_cast<HumanBone>(b));
    world[b] = world[parent] * motion.rotation[b];
  }
  return joints;
}

}  // namespace telemime
