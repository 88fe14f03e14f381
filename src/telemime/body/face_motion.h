// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <string_view>

namespace telemime {

/// The 52 coefficients of ARKit's face in the order of their names. Left and right are the person's own.
enum class Expression : std::size_t {
  brow_down_left,
  brow_down_right,
  brow_inner_up,
  brow_outer_up_left,
  brow_outer_up_right,
  cheek_puff,
  cheek_squint_left,
  cheek_squint_right,
  eye_blink_left,
  eye_blink_right,
  eye_look_down_left,
  eye_look_down_right,
  eye_look_in_left,
  eye_look_in_right,
  eye_look_out_left,
  eye_look_out_right,
  eye_look_up_left,
  eye_look_up_right,
  eye_squint_left,
  eye_squint_right,
  eye_wide_left,
  eye_wide_right,
  jaw_forward,
  jaw_left,
  jaw_open,
  jaw_right,
  mouth_close,
  mouth_dimple_left,
  mouth_dimple_right,
  mouth_frown_left,
  mouth_frown_right,
  mouth_funnel,
  mouth_left,
  mouth_lower_down_left,
  mouth_lower_down_right,
  mouth_press_left,
  mouth_press_right,
  mouth_pucker,
  mouth_right,
  mouth_roll_lower,
  mouth_roll_upper,
  mouth_shrug_lower,
  mouth_shrug_upper,
  mouth_smile_left,
  mouth_smile_right,
  mouth_stretch_left,
  mouth_stretch_right,
  mouth_upper_up_left,
  mouth_upper_up_right,
  nose_sneer_left,
  nose_sneer_right,
  tongue_out,
};
inline constexpr std::size_t kExpressionCount = 52;
/// Their names in ARKit.
inline constexpr std::array<std::string_view, kExpressionCount> kExpressionNames = {
    "browDownLeft",      "browDownRight",      "browInnerUp",         "browOuterUpLeft",
    "browOuterUpRight",  "cheekPuff",          "cheekSquintLeft",     "cheekSquintRight",
    "eyeBlinkLeft",      "eyeBlinkRight",      "eyeLookDownLeft",     "eyeLookDownRight",
    "eyeLookInLeft",     "eyeLookInRight",     "eyeLookOutLeft",      "eyeLookOutRight",
    "eyeLookUpLeft",     "eyeLookUpRight",     "eyeSquintLeft",       "eyeSquintRight",
    "eyeWideLeft",       "eyeWideRight",       "jawForward",          "jawLeft",
    "jawOpen",           "jawRight",           "mouthClose",          "mouthDimpleLeft",
    "mouthDimpleRight",  "mouthFrownLeft",     "mouthFrownRight",     "mouthFunnel",
    "mouthLeft",         "mouthLowerDownLeft", "mouthLowerDownRight", "mouthPressLeft",
    "mouthPressRight",   "mouthPucker",        "mouthRight",          "mouthRollLower",
    "mouthRollUpper",    "mouthShrugLower",    "mouthShrugUpper",     "mouthSmileLeft",
    "mouthSmileRight",   "mouthStretchLeft",   "mouthStretchRight",   "mouthUpperUpLeft",
    "mouthUpperUpRight", "noseSneerLeft",      "noseSneerRight",      "tongueOut"};

/// How the head is held, where the eyes look and what the face does.
struct FaceMotion {
  double confidence = 0.0;  ///< in [0, 1]; 0: the face is not seen and at rest
  /// Camera from head. The head's axes are the camera's when the person looks straight along the camera's
  /// axis into the lens: x to the person's left, y to the chin, z to the back of the head.
  Eigen::Quaterniond head = Eigen::Quaterniond::Identity();
  /// Direction of the eyes in the head, rad: to the person's left, and up.
  Eigen::Vector2d gaze = Eigen::Vector2d::Zero();
  std::array<double, kExpressionCount> expressions{};  ///< indexed by Expression, each in [0, 1]
  double detail = 1.0;  ///< in [0, 1]: by which gaze and expressions of a small face are reduced
  /// How much two looks at the same picture differ in what they measure: 0 where it is not known.
  struct Noise {
    double gaze = 0.0;  ///< rad
    std::array<double, kExpressionCount> expressions{};
  };
  Noise noise;

  double& operator[](Expression e) { return expressions[static_cast<std::size_t>(e)]; }
  double operator[](Expression e) const { return expressions[static_cast<std::size_t>(e)]; }
};

}  // namespace telemime
