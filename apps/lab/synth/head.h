// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>

#include "lab/synth/look.h"

namespace telemime {

/// The head in its own frame: origin at the skull base, x to the person's own left, y up, z forward, metres
/// of a head whose crown is 0.147 m above the skull base. Proportions of the face after the canons of
/// drawing: eyes at half height, nose to the lower third.
struct AvatarHead {
  float width = 1.0f;
  float jaw = 1.0f;
  HairStyle style = HairStyle::short_hair;
};
inline constexpr float kHeadCrown = 0.147f;  ///< m above the skull base, hair not counted
inline constexpr float kHeadReach = 0.185f;  ///< m from (0, 0.035, 0): nothing of head and cap lies farther

/// Distance (m) to the skin of the head: skull, jaw, brow, nose, eyeballs, lips, ears.
float face_distance(const AvatarHead& head, const Eigen::Vector3f& p);

/// Distance (m) to the hair.
float hair_distance(const AvatarHead& head, const Eigen::Vector3f& p);

/// Colour (linear light) of the skin of the head at a point on its surface: brows, eyes, lids, lips and blush
/// are painted, as a frontal face detector needs them.
Eigen::Vector3f face_colour(const Look& look, const Eigen::Vector3f& p);

}  // namespace telemime
