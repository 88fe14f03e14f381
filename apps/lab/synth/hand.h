// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <array>

#include "lab/synth/sdf.h"

namespace telemime {

/// A hand in its own frame: origin at the wrist, x toward the thumb, y along the fingers, z out of the back;
/// metres of a hand whose middle knuckle is 0.092 m from the wrist.
struct HandShape {
  std::array<RoundCone, 5> palm;                    ///< metacarpals, the ball of the thumb
  std::array<std::array<RoundCone, 3>, 4> fingers;  ///< index to little finger, from the knuckle on
  std::array<RoundCone, 2> thumb;
};
inline constexpr float kHandKnuckle = 0.092f;
inline constexpr float kHandReach = 0.115f;  ///< m from (0, 0.085, 0): no part of the hand lies farther

/// curl: 0 flat ... 1 fist.
HandShape hand_shape(double curl);

/// Distance (m) to the surface of the hand.
float distance(const HandShape& hand, const Eigen::Vector3f& p);

}  // namespace telemime
