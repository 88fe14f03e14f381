// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "lab/synth/actor.h"
#include "telemime/core/random.h"

namespace telemime {

enum class HairStyle : std::uint8_t { cap, short_hair, bob };

/// What the synthetic person looks like. Colours are linear light, red green blue, in [0, 1].
struct Look {
  ActorBuild build;
  Eigen::Vector3f skin{0.62f, 0.36f, 0.25f};
  Eigen::Vector3f shirt{0.04f, 0.20f, 0.45f};
  Eigen::Vector3f shirt2{0.60f, 0.60f, 0.58f};  ///< second colour of the stripes
  Eigen::Vector3f trousers{0.03f, 0.035f, 0.05f};
  Eigen::Vector3f hair{0.02f, 0.014f, 0.01f};
  Eigen::Vector3f eyes{0.06f, 0.04f, 0.03f};
  HairStyle style = HairStyle::short_hair;
  bool striped = false;
  double sleeve = 0.58;       ///< end of the sleeve: 0 shoulder, 1 elbow, 2 wrist
  double bust = 0.0;          ///< 0 flat ... 1
  float face_width = 1.0f;    ///< against the average
  float jaw = 1.0f;           ///< width of the jaw against the average
  std::uint32_t texture = 0;  ///< seed of the cloth's and skin's mottling
  int shirt_index = 0;        ///< which entry of the palette the shirt is
};

/// A colour given as sRGB-like 0..255 values, to linear light with the gamma of 2 that the renderer uses.
Eigen::Vector3f linear_colour(float red, float green, float blue);

/// Draws a look. The shirts avoid the hues of skin.
Look random_look(Random& random);

}  // namespace telemime
