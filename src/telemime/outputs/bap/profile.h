// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <span>
#include <string_view>

#include "telemime/body/pose.h"
#include "telemime/outputs/euler.h"

namespace telemime {

enum class BapKind { rotation, translation };

/// Axis of the body frame of H-Anim that a positive value turns about or moves along.
struct SignedAxis {
  int axis = 0;  ///< 0 = x (avatar's left), 1 = y (up), 2 = z (forward)
  int sign = 1;  ///< +1 or -1
};

/// One body animation parameter of MPEG-4.
struct Bap {
  int id = 0;  ///< 1 to 186
  std::string_view name;
  BapKind kind = BapKind::rotation;
  SignedAxis visage;  ///< as in the header of the Visage FBA library
  SignedAxis greta;   ///< as in the Greta platform
};

inline constexpr int kBapCount = 186;

/// All of them, by id; element 0 is id 1. The rows come from data/bap.csv.
std::span<const Bap> bap_table();

/// The parameter with this id, 1 to 186. Throws Error(usage) outside.
const Bap& bap(int id);

/// How three angles of the pose reach a player: the parameters that carry the rotation about x, y and z, and
/// the order in which the player multiplies them (outermost first).
struct BapJoint {
  std::array<int, 3> id;  ///< of the rotation about x, y, z
  AxisOrder order;
};

/// Conventions of one player of BAP files (docs/formats.md). A constant.
struct BapProfile {
  std::string_view name;
  std::string_view version;  ///< first word of the file
  int mask_length;           ///< bits in the mask of each frame
  double units_per_radian;   ///< 1e5 of the standard
  SignedAxis Bap::*sign;     ///< which of the two sign tables holds
  BapJoint trunk, neck;      ///< thesis Table 2-2: vl5 and skullbase
  BapJoint l_shoulder, r_shoulder;
  BapJoint l_wrist, r_wrist;
  AxisOrder finger_order;  ///< of the first joint of each finger
  bool palms_forward;  ///< the table's axes of the fingers hold with the palms to the front, not the thighs
};

/// iso, greta, vreng-3.1, vreng-3.2.
std::span<const BapProfile> bap_profiles();

/// By name; "visage" is another name of "iso". Throws Error(usage) that lists the names.
const BapProfile& bap_profile(std::string_view name);

/// The ids that carry the 20 angles of a pose in this profile, ascending.
std::array<int, kAngleCount> bap_ids(const BapProfile& profile);

/// Values of the parameters, by place in bap_ids.
using BapValues = std::array<int, kAngleCount>;

/// The pose as the player turns its joints: equal as rotations, not angle by angle. `last` (values of the
/// frame before, or zeros) decides between equal solutions. The translation of the root is not sent, as in
/// the thesis.
BapValues encode_bap(const BapProfile& profile, const Pose& pose, const BapValues& last);

/// The inverse: angles of the pose, near to those of `near`, whose translation is kept.
Pose decode_bap(const BapProfile& profile, const BapValues& values, const Pose& near);

}  // namespace telemime
