// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "telemime/body/skeleton.h"

namespace telemime {

/// Bone lengths of the synthetic person, metres. Not the tracker's body: other proportions, a clavicle that
/// carries the shoulder, a spine of one bone.
struct ActorBuild {
  double spine = 0.50;           ///< fifth lumbar to seventh cervical vertebra
  double neck_up = 0.113;        ///< seventh cervical vertebra to the skull base, up ...
  double neck_forward = 0.043;   ///< ... and forward
  double head_up = 0.147;        ///< skull base to crown
  double clavicle = 0.172;       ///< spine to shoulder, to the side
  double shoulder_drop = 0.096;  ///< shoulder below the seventh cervical vertebra, arms hanging
  double shoulder_forward = 0.022;
  double upper_arm = 0.280;
  double forearm = 0.248;
  double hand = 0.092;  ///< wrist to middle knuckle
  double girth = 1.0;   ///< thickness of trunk and limbs against the average
};

/// An average build scaled to a height ratio (1 is about 1.72 m), with this girth.
ActorBuild scaled_build(double height, double girth);

/// How much index, middle, ring and little finger and the thumb are bent: 0 straight ... 1 as in a fist.
using FingerCurls = std::array<double, 5>;

/// Directions are in the chest's frame: x OUTWARD (away from the midline on either side), y up, z forward.
struct ActorArm {
  Eigen::Vector3d upper{0.46, -0.88, 0.08};  ///< shoulder to elbow, any length but 0
  Eigen::Vector3d fore{0.78, -0.45, 0.43};   ///< elbow to wrist
  double pronation = 1.0;  ///< rad; 0: thumb on the side to which the elbow bends, + palm turned away from it
  double extension = 0.0;  ///< rad; + bends the hand toward its back
  double curl = 0.3;       ///< 0 flat hand ... 1 fist
  FingerCurls curl_by_finger{};  ///< added to `curl`
};

/// What the synthetic person does at one moment.
struct ActorPose {
  Eigen::Vector3d root{0.0, 0.46, 1.30};  ///< fifth lumbar vertebra, camera frame, m
  double lean = 0.0;                      ///< rad; + forward, toward the camera
  double sway = 0.0;                      ///< rad; + toward the person's own left
  double turn = 0.0;                      ///< rad; + turns the chest toward the person's own left
  double nod = 0.0;                       ///< rad; head against the chest, + face down
  double look = 0.0;                      ///< rad; + face toward the person's own left
  double tilt = 0.0;                      ///< rad; + crown toward the person's own left
  std::array<ActorArm, 2> arms{};         ///< by Side
};

/// Where everything is. Frames have body axes (x own left, y up, z forward); all in the camera's frame, m.
struct ActorKinematics {
  Eigen::Isometry3d camera_from_chest;  ///< origin: root
  Eigen::Isometry3d camera_from_head;   ///< origin: skull base
  /// Origin: wrist; x toward the thumb, y along the fingers, z out of the back of the hand. Left-handed for
  /// one side (both hands share one shape), therefore matrices.
  std::array<Eigen::Matrix3d, 2> camera_from_hand;
  std::array<FingerCurls, 2> curl{};  ///< by Side
  JointPositions joints;
};

/// Places the bones. The shoulders rise and come forward with the arms, by rotation of the clavicle: bone
/// lengths stay as in the build.
ActorKinematics actor_kinematics(const ActorBuild& build, const ActorPose& pose);

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
inline constexpr std::span kThesisGestures = std::span(kGestureNames).first<4>();
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
