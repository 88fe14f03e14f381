// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "telemime/body/arm_ik.h"
#include "telemime/body/limits.h"

namespace telemime {

/// The other poses of one arm whose elbow and wrist lie on the same viewing rays (thesis 4.4.2.2.3): each ray
/// meets the sphere about the parent joint twice, so there are up to 3 (another wrist; another elbow with a
/// near or a far wrist). The shoulder moves with the clavicle, so the elbow's sphere is found by fixed-point
/// iteration; the angles are in closed form. Returns only poses inside the limits and without
/// interpenetration; the angles of the hand do not change.
std::vector<Pose> arm_flips(const Body& body, const Pose& pose, Side side, const JointLimits& limits);

/// All combinations of the flips of both arms: up to 15 poses.
std::vector<Pose> kinematic_flips(const Body& body, const Pose& pose, const JointLimits& limits);

}  // namespace telemime
