// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "lab/synth/actor.h"

namespace telemime {

/// The four communicative gestures of the thesis (3.6.2, figures 3-20 to 3-23), restaged, and everyday
/// talking.
enum class Gesture : std::uint8_t {
  raising_arms,  ///< beside the body, hands up; little depth, no occlusion
  joy,           ///< arms up and forward, one fast drop and raise, hands before the face
  exclaiming,    ///< hands toward the camera, upper arms rotate, forearms cross the chest
  asking,        ///< palms up, far forward and back, one fast retract and thrust
  talking,       ///< slow gestures before the trunk, hands in the lap between them; not in the thesis
};
inline constexpr std::size_t kGestureCount = 5;
inline constexpr std::array<std::string_view, kGestureCount> kGestureNames = {
    "raising_arms", "joy", "exclaiming", "asking", "talking"};
/// The first of them are the thesis's.
inline constexpr std::size_t kThesisGestureCount = 4;
inline constexpr int kGestureFrames = 165;
inline constexpr double kGestureFps = 25.0;

/// The gesture of this name. Throws Error(usage) that lists the names.
Gesture gesture_named(std::string_view name);

/// A one-line description for truth.json.
std::string_view gesture_note(Gesture gesture);

/// The actor at one key frame: both arms (ActorArm's conventions), lean and nod in degrees.
struct GestureArmKey {
  std::array<double, 3> upper;
  std::array<double, 3> fore;
  double pronation;  ///< degrees
  double extension;  ///< degrees
  double curl;
};
struct GestureKey {
  double frame;
  GestureArmKey left;
  GestureArmKey right;
  double lean;
  double nod;
};

/// The key frames, by increasing frame from 0 to 164; the first and the last are the same pose of rest.
std::span<const GestureKey> gesture_keys(Gesture gesture);

/// The pose at a (fractional) frame of the 25-fps clip; after its end the gesture repeats. Between the keys
/// each number follows a monotone cubic (Fritsch & Carlson, SIAM J. Numer. Anal. 17, 1980), which does not
/// overshoot. `seed` adds human variation: one arm slightly behind the other, small slow drifts of every
/// joint, and the position of the person (within centimetres of the middle, 1.36 to 1.42 m from the camera).
ActorPose gesture_pose(Gesture gesture, double frame, std::uint64_t seed);

}  // namespace telemime
