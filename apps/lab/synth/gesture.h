// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "lab/synth/actor.h"

namespace telemime {

/// The four communicative gestures of the thesis (3.6.2, figures 3-20 to 3-23), staged anew.
enum class Gesture : std::uint8_t {
  raising_arms,  ///< beside the body, hands up; little depth, no occlusion
  joy,           ///< arms up and forward, one fast drop and raise, hands before the face
  exclaiming,    ///< hands toward the camera, upper arms rotate, forearms cross the chest
  asking,        ///< palms up, far forward and back, one fast retract and thrust
};
inline constexpr std::size_t kGestureCount = 4;
inline constexpr std::array<std::string_view, kGestureCount> kGestureNames = {"raising_arms", "joy",
                                                                              "exclaiming", "asking"};
inline constexpr int kGestureFrames = 165;
inline constexpr double kGestureFps = 25.0;

/// The gesture of this name. Throws Error(usage) that lists the names.
Gesture gesture_named(std::string_view name);

/// One line on what happens in it, for truth.json.
std::string_view gesture_note(Gesture gesture);

/// What the actor holds at one key frame: both arms (ActorArm's conventions), lean and nod in degrees.
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

/// The pose at a (fractional) frame of the 25-fps clip; beyond its end the gesture starts again. Between the
/// keys each number follows a monotone cubic (Fritsch & Carlson, SIAM J. Numer. Anal. 17, 1980), so that
/// nothing swings over. `seed` varies it as people do: one arm a little behind the other, small slow drifts
/// of every joint, where the person sits (within some centimetres of the middle, 1.36 to 1.42 m away).
ActorPose gesture_pose(Gesture gesture, double frame, std::uint64_t seed);

}  // namespace telemime
