// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

#include "telemime/body/body.h"
#include "telemime/body/hand_model.h"

namespace telemime {

/// A hand in one frame. What was seen of it is attached at the wrist of the body, whose pose it does not
/// change.
struct HandMotion {
  HandSizes sizes = average_hand(1.72);
  HandAngles angles = resting_hand();
  /// camera_from_hand as it was seen; empty: as the body's hand.
  std::optional<Eigen::Quaterniond> seen;
  double visibility = 0.0;  ///< in [0, 1]; 0: not seen, at rest
  double spread = 0.0;      ///< standard deviation of a joint relative to the wrist, m

  // Set by place_hands().
  WristAngles wrist{};
  HandPoints joints = points_at_origin();  ///< m, camera frame
};
using HandMotions = std::array<HandMotion, 2>;  ///< by Side

/// Turns the hands about the wrists of this pose, within the wrists' limits, and sets their joints.
void place_hands(const Kinematics& kinematics, HandMotions& hands);

/// The pose whose wrists are turned as the hands are.
Pose with_wrists(const Pose& pose, const HandMotions& hands);

/// The mirror image of the hands, for mirrored(pose): place them afterwards.
HandMotions mirrored(const HandMotions& hands);

}  // namespace telemime
