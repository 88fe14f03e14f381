// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "telemime/nets/pose_landmarks.h"

namespace telemime {

/// What is known about the direction in which a person's trunk faces, from one frame to the next.
struct TrunkFacing {
  double angle = 0.0;  ///< between the line of the shoulders and the viewing ray, rad: pi/2 faces the camera,
                       ///< -pi/2 turns the back to it
  double time = 0.0;   ///< of the frame, s
  double agreed = 0.0;  ///< for how long the network must contradict this to be believed, at most 0.5 s
};

/// The same landmarks of a body that faces the other way: left and right are exchanged and depths mirrored.
/// Both bodies have the same outline.
PoseLandmarks facing_other_way(PoseLandmarks landmarks);

/// The landmarks with left and right as in the frames before. In poor pictures the network takes a person
/// who faces the camera for one seen from behind, for some frames; nobody turns as fast as that (10 rad/s).
/// If the network does not change its mind within the time for which it agreed before, it is believed.
/// Whoever appears faces the camera until the network has seen their back for half a second. `facing` is that
/// of the frame before, empty for the first, and becomes that of this one. `time` in s.
PoseLandmarks with_steady_sides(PoseLandmarks landmarks, double time, std::optional<TrunkFacing>& facing);

}  // namespace telemime
