// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "telemime/core/camera.h"
#include "telemime/core/frame.h"

namespace telemime {

/// Twelve frames of the gesture joy at 320x240, and frames of the empty background.
struct SyntheticClip {
  Camera camera;
  std::vector<Frame> background;
  std::vector<Frame> frames;
};

SyntheticClip make_synthetic_clip();

}  // namespace telemime
