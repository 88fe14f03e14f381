// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/bap/profile.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "telemime/body/rotations.h"
#include "telemime/core/errors.h"
#include "telemime/core/text.h"

namespace telemime {
namespace {

constexpr SignedAxis axis(std::string_view text) {
  return {text[1] - 'X', text[0] == '-' ? -1 : 1};
}

constexpr std::array<Bap, kBapCount> kBapTable = {{
#include "bap_rows.inc"
}};

constexpr AxisOrder kXzy = {0, 2, 1};
constexpr AxisOrder kZxy = {2, 0, 1};
constexpr AxisOrder kZyx = {2, 1, 0};
constexpr AxisOrder kYxz = {1, 0, 2};
constexpr double kStandardUnit = 1e5;

// The standard multiplies the rotations with the lowest id outermost: spine roll (z), torsion (y), tilt (x);
// shoulder flexion (x), abduct (z), twisting (y); wrist flexion (z), pivot (x), twisting (y). Greta's player
// multiplies Rz Ry Rx everywhere. VREng draws the trunk from the sacroiliac joint and the neck from vc4, as
// Rx Rz Ry, and both arm joints as Rz Rx Ry.
constexpr std::array<BapProfile, 4> kProfiles = [] {
  const BapProfile iso = {.name = "iso",
                          .version = "3.1",
                          .mask_length = kBapCount,
                          .units_per_radian = kStandardUnit,
                          .sign = &Bap::visage,
                          .trunk = {{122, 121, 120}, kZyx},
                          .neck = {{50, 49, 48}, kZyx},
                          .l_shoulder = {{32, 36, 34}, kXzy},
                          .r_shoulder = {{33, 37, 35}, kXzy},
                          .l_wrist = {{44, 46, 42}, kZxy},
                          .r_wrist = {{45, 47, 43}, kZxy},
                          .finger_order = kXzy,
                          .palms_forward = true};
  BapProfile greta = iso;
  greta.name = "greta";
  greta.version = "2.1";
  greta.mask_length = 295;
  greta.sign = &Bap::greta;
  greta.l_shoulder.order = greta.r_shoulder.order = greta.l_wrist.order = greta.r_wrist.order = kZyx;
  greta.finger_order = kZyx;
  greta.palms_forward = false;
  BapProfile vreng = iso;
  vreng.name = "vreng-3.1";
  vreng.trunk = {{1, 2, 3}, kXzy};
  vreng.neck = {{62, 61, 60}, kXzy};
  vreng.l_shoulder.order = vreng.r_shoulder.order = kZxy;
  BapProfile vreng_in_half_turns = vreng;
  vreng_in_half_turns.name = "vreng-3.2";
  vreng_in_half_turns.version = "3.2";
  vreng_in_half_turns.units_per_radian = kStandardUnit / std::numbers::pi;
  return std::array<BapProfile, 4>{iso, greta, vreng, vreng_in_half_turns};
}();

constexpr std::array<int, 2> kElbowIds = {38, 39};
constexpr std::array<Angle, 2> kElbows = {Angle::l_elbow_flexion, Angle::r_elbow_flexion};

/// A joint of the pose, its angles about x, y and z, and the order in which the body multiplies them
/// (pose.h).
struct PoseJoint {
  BapJoint BapProfile::*target;
  std::array<Angle, 3> angles;
  AxisOrder order;
};

constexpr std::array<PoseJoint, 6> kPoseJoints = {{
    {&BapProfile::trunk, {Angle::root_tilt, Angle::root_torsion, Angle::root_roll}, kZxy},
    {&BapProfile::neck, {Angle::neck_tilt, Angle::neck_torsion, Angle::neck_roll}, kZxy},
    {&BapProfile::l_shoulder,
     {Angle::l_shoulder_flexion, Angle::l_shoulder_twisting, Angle::l_shoulder_abduct},
     kZxy},
    {&BapProfile::r_shoulder,
     {Angle::r_shoulder_flexion, Angle::r_shoulder_twisting, Angle::r_shoulder_abduct},
     kZxy},
    {&BapProfile::l_wrist, {Angle::l_wrist_pivot, Angle::l_wrist_twisting, Angle::l_wrist_flexion}, kYxz},
    {&BapProfile::r_wrist, {Angle::r_wrist_pivot, Angle::r_wrist_twisting, Angle::r_wrist_flexion}, kYxz},
}};

std::size_t place(const std::array<int, kAngleCount>& ids, int id) {
  return static_cast<std::size_t>(std::lower_bound(ids.begin(), ids.end(), id) - ids.begin());
}

/// Value of one radian about the positive axis.
double unit(const BapProfile& profile, int id) {
  return profile.units_per_radian * (bap(id).*profile.sign).sign;
}

EulerAngles pose_angles(const PoseJoint& joint, const Pose& pose) {
  EulerAngles angles{};
  for (std::size_t i = 0; i < 3; ++i) {
    angles[i] = pose[joint.angles[static_cast<std::size_t>(joint.order[i])]];
  }
  return angles;
}

EulerAngles player_angles(const BapProfile& profile, const BapJoint& joint, const BapValues& values,
                          const std::array<int, kAngleCount>& ids) {
  EulerAngles angles{};
  for (std::size_t i = 0; i < 3; ++i) {
    const int id = joint.id[static_cast<std::size_t>(joint.order[i])];
    angles[i] = values[place(ids, id)] / unit(profile, id);
  }
  return angles;
}

}  // namespace

std::span<const Bap> bap_table() {
  return kBapTable;
}

const Bap& bap(int id) {
  if (id < 1 || id > kBapCount) {
    throw Error(ErrorKind::usage, "there is no body animation parameter " + std::to_string(id),
                "ids are 1 to 186");
  }
  return kBapTable[static_cast<std::size_t>(id - 1)];
}

std::span<const BapProfile> bap_profiles() {
  return kProfiles;
}

const BapProfile& bap_profile(std::string_view name) {
  for (const BapProfile& profile : kProfiles) {
    if (profile.name == name || (name == "visage" && profile.name == "iso")) {
      return profile;
    }
  }
  throw Error(ErrorKind::usage, "there is no BAP profile \"" + std::string(name) + "\"",
              "use one of " + joined(kProfiles, &BapProfile::name));
}

std::array<int, kAngleCount> bap_ids(const BapProfile& profile) {
  std::array<int, kAngleCount> ids{};
  auto next = ids.begin();
  for (const PoseJoint& joint : kPoseJoints) {
    next = std::copy((profile.*joint.target).id.begin(), (profile.*joint.target).id.end(), next);
  }
  std::copy(kElbowIds.begin(), kElbowIds.end(), next);
  std::sort(ids.begin(), ids.end());
  return ids;
}

BapValues encode_bap(const BapProfile& profile, const Pose& pose, const BapValues& last) {
  const auto ids = bap_ids(profile);
  BapValues values{};
  for (const PoseJoint& joint : kPoseJoints) {
    const BapJoint& target = profile.*joint.target;
    const EulerAngles angles = decompose(compose(joint.order, pose_angles(joint, pose)), target.order,
                                         player_angles(profile, target, last, ids));
    for (std::size_t i = 0; i < 3; ++i) {
      const int id = target.id[static_cast<std::size_t>(target.order[i])];
      values[place(ids, id)] = static_cast<int>(std::lround(angles[i] * unit(profile, id)));
    }
  }
  for (std::size_t side = 0; side < 2; ++side) {
    const int id = kElbowIds[side];
    values[place(ids, id)] =
        static_cast<int>(std::lround(wrap_angle(pose[kElbows[side]]) * unit(profile, id)));
  }
  return values;
}

Pose decode_bap(const BapProfile& profile, const BapValues& values, const Pose& near) {
  const auto ids = bap_ids(profile);
  Pose pose = near;
  for (const PoseJoint& joint : kPoseJoints) {
    const BapJoint& source = profile.*joint.target;
    const EulerAngles angles = decompose(compose(source.order, player_angles(profile, source, values, ids)),
                                         joint.order, pose_angles(joint, near));
    for (std::size_t i = 0; i < 3; ++i) {
      pose[joint.angles[static_cast<std::size_t>(joint.order[i])]] = angles[i];
    }
  }
  for (std::size_t side = 0; side < 2; ++side) {
    pose[kElbows[side]] = values[place(ids, kElbowIds[side])] / unit(profile, kElbowIds[side]);
  }
  return pose;
}

}  // namespace telemime
