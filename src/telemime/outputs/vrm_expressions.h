// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string_view>

#include "telemime/body/face_motion.h"

namespace telemime {

/// The expressions of VRM that faces are given, by their names in VRM 1.0.
inline constexpr std::size_t kVrmExpressionCount = 17;
inline constexpr std::array<std::string_view, kVrmExpressionCount> kVrmExpressionNames = {
    "happy", "angry", "sad",       "relaxed",    "surprised", "aa",       "ih",       "ou",       "ee",
    "oh",    "blink", "blinkLeft", "blinkRight", "lookUp",    "lookDown", "lookLeft", "lookRight"};
/// Their names in VRM 0 (BlendShapePreset), in which VMC sends them.
inline constexpr std::array<std::string_view, kVrmExpressionCount> kVrm0ExpressionNames = {
    "Joy", "Angry", "Sorrow",  "Fun",     "Surprised", "A",        "I",        "U",        "E",
    "O",   "Blink", "Blink_L", "Blink_R", "LookUp",    "LookDown", "LookLeft", "LookRight"};

/// The weights of these expressions, each in [0, 1]: docs/face.md has the formula of each. The five mouth
/// shapes together are at most 1; what both eyelids do is in blink, and the rest in blinkLeft and blinkRight.
std::array<double, kVrmExpressionCount> vrm_expressions(const FaceMotion& face);

}  // namespace telemime
