// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "telemime/body/body.h"
#include "telemime/body/limits.h"

namespace telemime {

/// The pose with the left arm of one pose and the right arm of another: their wrists and elbows keep their
/// positions as far as the trunk of `pose` lets them, their hands keep their angles.
Pose with_arms_of(const Body& body, const Pose& pose, const Pose& left, const Pose& right,
                  const JointLimits& limits);

/// The first `most` poses whose elbow or wrist on that side is 3 cm or more from those of the poses taken
/// before them.
std::vector<Pose> distinct_arms(const Body& body, std::span<const Pose> poses, Side side, std::size_t most);

}  // namespace telemime
