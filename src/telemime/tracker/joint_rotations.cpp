// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/joint_rotations.h"

#include <cmath>
#include <cstddef>

#include "telemime/body/rotations.h"

namespace telemime {
namespace {

struct ZxyJoint {
  Angle z, x, y;
};

constexpr std::array<ZxyJoint, 4> kZxyJoints = {{
    {Angle::root_roll, Angle::root_tilt, Angle::root_torsion},
    {Angle::neck_roll, Angle::neck_tilt, Angle::neck_torsion},
    {Angle::l_shoulder_abduct, Angle::l_shoulder_flexion, Angle::l_shoulder_twisting},
    {Angle::r_shoulder_abduct, Angle::r_shoulder_flexion, Angle::r_shoulder_twisting},
}};
/// The wrists are composed as Ry Rx Rz; their inverse is Rz Rx Ry of the negated angles.
constexpr std::array<ZxyJoint, 2> kWrists = {{
    {Angle::l_wrist_flexion, Angle::l_wrist_pivot, Angle::l_wrist_twisting},
    {Angle::r_wrist_flexion, Angle::r_wrist_pivot, Angle::r_wrist_twisting},
}};
constexpr std::array<Angle, 2> kElbows = {Angle::l_elbow_flexion, Angle::r_elbow_flexion};

constexpr double kSingular = 1e-6;  // cosine of the middle angle

/// The same direction of turning, as near to `near` as whole turns allow.
double unwrapped(double angle, double near) {
  return near + wrap_angle(angle - near);
}

double distance(const AnglesZxy& a, const AnglesZxy& b) {
  return std::abs(wrap_angle(a.z - b.z)) + std::abs(wrap_angle(a.x - b.x)) + std::abs(wrap_angle(a.y - b.y));
}

AnglesZxy nearest_zxy(const Eigen::Matrix3d& rotation, const AnglesZxy& near) {
  const auto [first, second] = decompose_zxy(rotation);
  AnglesZxy best = distance(first, near) <= distance(second, near) ? first : second;
  if (std::abs(std::cos(best.x)) < kSingular) {  // only z + y or z - y is determined: y stays as it was
    const Eigen::Matrix3d rest = rotation * rotation_y(-near.y);
    best.y = near.y;
    best.z = std::atan2(rest(1, 0), rest(0, 0));
  }
  return {unwrapped(best.z, near.z), unwrapped(best.x, near.x), unwrapped(best.y, near.y)};
}

}  // namespace

JointRotations rotations_of(const Pose& pose) {
  JointRotations result;
  result.root = pose.root;
  for (std::size_t j = 0; j < kZxyJoints.size(); ++j) {
    const auto& [z, x, y] = kZxyJoints[j];
    result.rotation[j] = Eigen::Quaterniond(compose_zxy({pose[z], pose[x], pose[y]}));
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const auto& [z, x, y] = kWrists[side];
    result.rotation[kZxyJoints.size() + side] =
        Eigen::Quaterniond(compose_zxy({-pose[z], -pose[x], -pose[y]})).conjugate();
    result.elbow[side] = pose[kElbows[side]];
  }
  return result;
}

Pose pose_of(const JointRotations& rotations, const Pose& near) {
  Pose pose = near;
  pose.root = rotations.root;
  for (std::size_t j = 0; j < kZxyJoints.size(); ++j) {
    const auto& [z, x, y] = kZxyJoints[j];
    const AnglesZxy angles =
        nearest_zxy(rotations.rotation[j].toRotationMatrix(), {near[z], near[x], near[y]});
    pose[z] = angles.z;
    pose[x] = angles.x;
    pose[y] = angles.y;
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const auto& [z, x, y] = kWrists[side];
    const AnglesZxy angles =
        nearest_zxy(rotations.rotation[kZxyJoints.size() + side].conjugate().toRotationMatrix(),
                    {-near[z], -near[x], -near[y]});
    pose[z] = -angles.z;
    pose[x] = -angles.x;
    pose[y] = -angles.y;
    pose[kElbows[side]] = unwrapped(rotations.elbow[side], near[kElbows[side]]);
  }
  return pose;
}

Eigen::Vector3d turn_between(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  const Eigen::AngleAxisd turn(from.conjugate() * to);
  return wrap_angle(turn.angle()) * turn.axis();
}

}  // namespace telemime
