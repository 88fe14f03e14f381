// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "telemime/body/skeleton.h"
#include "telemime/core/camera.h"
#include "telemime/core/frame.h"

/// Pictures of a synthetic person and of the same room without one; small, so that tests stay quick.
namespace telemime::support {

inline constexpr double kClipFps = 25.0;

struct SyntheticClip {
  Camera camera;
  std::vector<Frame> background;      ///< the empty room
  std::vector<Frame> person;          ///< the first frames of a gesture
  std::vector<JointPositions> truth;  ///< of each frame with the person, m, camera frame
};

/// 320x240, always the same person.
SyntheticClip synthetic_clip(int background_frames, int person_frames);

}  // namespace telemime::support
