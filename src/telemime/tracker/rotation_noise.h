// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "telemime/body/motion_frame.h"
#include "telemime/core/camera.h"

namespace telemime {

/// How much larger the variance of each measured rotation is than that of a joint that is clearly seen.
struct NoiseRatios {
  std::array<double, 6> rotation{1.0, 1.0, 1.0, 1.0, 1.0, 1.0};  ///< in the order of JointRotations
  std::array<double, 2> elbow{1.0, 1.0};
};

/// An arm that is outside the image from the elbow on is as uncertain as its spread says, but for an upper
/// arm that is seen by half or more. An arm of which the elbow, the wrist or the hand is visible follows the
/// image, whatever the spread of the rest. `camera` is that of frame.pixels.
NoiseRatios noise_of(const MotionFrame& frame, const Camera& camera);

}  // namespace telemime
