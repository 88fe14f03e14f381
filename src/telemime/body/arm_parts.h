// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

#include "telemime/body/pose.h"
#include "telemime/body/skeleton.h"

namespace telemime {

/// The segments, joints and angles of one arm.
struct ArmParts {
  Segment upper_arm, forearm, hand;
  Joint shoulder, elbow, wrist;
  Joint knuckle;  ///< Joint::l_hand or r_hand
  Angle shoulder_flexion, shoulder_twisting, shoulder_abduct;
  Angle elbow_flexion;
  Angle wrist_flexion, wrist_twisting, wrist_pivot;

  /// The wrist's angles in the order in which a search has them: flexion, pivot, twisting.
  constexpr std::array<Angle, 3> wrist_angles() const { return {wrist_flexion, wrist_pivot, wrist_twisting}; }
};

/// Both arms, by Side.
inline constexpr std::array<ArmParts, 2> kArmParts = {{
    {.upper_arm = Segment::l_upper_arm,
     .forearm = Segment::l_forearm,
     .hand = Segment::l_hand,
     .shoulder = Joint::l_shoulder,
     .elbow = Joint::l_elbow,
     .wrist = Joint::l_wrist,
     .knuckle = Joint::l_hand,
     .shoulder_flexion = Angle::l_shoulder_flexion,
     .shoulder_twisting = Angle::l_shoulder_twisting,
     .shoulder_abduct = Angle::l_shoulder_abduct,
     .elbow_flexion = Angle::l_elbow_flexion,
     .wrist_flexion = Angle::l_wrist_flexion,
     .wrist_twisting = Angle::l_wrist_twisting,
     .wrist_pivot = Angle::l_wrist_pivot},
    {.upper_arm = Segment::r_upper_arm,
     .forearm = Segment::r_forearm,
     .hand = Segment::r_hand,
     .shoulder = Joint::r_shoulder,
     .elbow = Joint::r_elbow,
     .wrist = Joint::r_wrist,
     .knuckle = Joint::r_hand,
     .shoulder_flexion = Angle::r_shoulder_flexion,
     .shoulder_twisting = Angle::r_shoulder_twisting,
     .shoulder_abduct = Angle::r_shoulder_abduct,
     .elbow_flexion = Angle::r_elbow_flexion,
     .wrist_flexion = Angle::r_wrist_flexion,
     .wrist_twisting = Angle::r_wrist_twisting,
     .wrist_pivot = Angle::r_wrist_pivot},
}};

/// The segments, joints and angles of the arm of this side.
constexpr const ArmParts& arm_parts(Side side) {
  return kArmParts[static_cast<std::size_t>(side)];
}

}  // namespace telemime
