// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/body/body.h"

namespace telemime {

/// The penetration depth of the arms in the chest, the head and each other: the sum over pairs of segments of
/// the depth (m) by which their inner capsules overlap. 0 for a pose without interpenetration. The capsules
/// are thinner than the surfaces, so that contact (a hand on the chest, clasped hands) costs nothing.
double interpenetration(const Body& body, const Kinematics& kinematics);

/// Poses with a larger depth (m) are invalid (thesis 2.4.1: no arm inside the chest).
inline constexpr double kInvalidInterpenetration = 0.02;

}  // namespace telemime
