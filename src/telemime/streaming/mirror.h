// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/outputs/encoder.h"

namespace telemime {

/// A stream seen in a mirror, the plane x = 0 of the camera frame (body/pose.h): left and right exchanged,
/// also in the body's lengths, so that joints and kinematics agree. The joint limits are not mirrored,
/// because no sender uses them.
StreamHeader mirrored(const StreamHeader& header);

/// Mirrors a frame of that stream. Pixels are those of the mirrored joints in the same camera.
MotionFrame mirrored(const MotionFrame& frame, const Camera& camera);

}  // namespace telemime
