// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/vrm_expressions.h"

#include <algorithm>

namespace telemime {

std::array<double, kVrmExpressionCount> vrm_expressions(const FaceMotion& face) {
  using enum Expression;
  const auto mean = [&](Expression left, Expression right) { return 0.5 * (face[left] + face[right]); };
  const auto ramp = [](double value, double from, double to) {
    return std::clamp((value - from) / (to - from), 0.0, 1.0);
  };
  const double smile = mean(mouth_smile_left, mouth_smile_right);
  const double brows_down = mean(brow_down_left, brow_down_right);
  const double brows_up = std::max(face[brow_inner_up], mean(brow_outer_up_left, brow_outer_up_right));
  const double wide = mean(eye_wide_left, eye_wide_right);
  const double frown = mean(mouth_frown_left, mouth_frown_right);
  // Emotions: what is clearly shown. A gentle smile is relaxed, a broad one happy.
  const double happy = ramp(smile, 0.35, 0.85);
  const double angry = ramp(brows_down, 0.4, 0.9) * (1.0 - happy);
  const double sad = ramp(0.6 * frown + 0.4 * face[brow_inner_up], 0.35, 0.8) * (1.0 - happy);
  const double relaxed = ramp(smile, 0.1, 0.35) * (1.0 - happy) * (1.0 - angry);
  const double surprised = ramp(brows_up, 0.3, 0.8) * ramp(std::max(face[jaw_open], wide), 0.15, 0.5);
  // Vowels by the opening of the jaw, the roundness and the width of the lips.
  const double open = std::max(face[jaw_open] - face[mouth_close], 0.0);
  const double round = std::max(face[mouth_funnel], face[mouth_pucker]);
  const double broad = std::max(mean(mouth_stretch_left, mouth_stretch_right), 0.5 * smile);
  const double apart = std::max(mean(mouth_lower_down_left, mouth_lower_down_right),
                                mean(mouth_upper_up_left, mouth_upper_up_right));
  std::array<double, 5> vowels = {
      ramp(open, 0.05, 0.6) * (1.0 - round) * (1.0 - 0.5 * broad),                           // aa
      ramp(apart, 0.1, 0.7) * (1.0 - round) * (1.0 - ramp(open, 0.1, 0.5)) * (1.0 - broad),  // ih
      round * (1.0 - ramp(open, 0.1, 0.4)),                                                  // ou
      broad * ramp(apart + open, 0.1, 0.6) * (1.0 - round),                                  // ee
      round * ramp(open, 0.1, 0.4)};                                                         // oh
  const double sum = vowels[0] + vowels[1] + vowels[2] + vowels[3] + vowels[4];
  for (double& vowel : vowels) {
    vowel /= std::max(sum, 1.0);
  }
  const auto [a, i, u, e, o] = vowels;
  const double left = face[eye_blink_left];
  const double right = face[eye_blink_right];
  const double blink = std::min(left, right);
  constexpr double kFarthest = 0.52;  // rad, of the gaze
  const double up = ramp(face.gaze.y(), 0.0, kFarthest);
  const double down = ramp(-face.gaze.y(), 0.0, kFarthest);
  const double to_left = ramp(face.gaze.x(), 0.0, kFarthest);
  const double to_right = ramp(-face.gaze.x(), 0.0, kFarthest);
  return {happy, angry, sad,          relaxed,       surprised, a,    i,       u,       e,
          o,     blink, left - blink, right - blink, up,        down, to_left, to_right};
}

}  // namespace telemime
