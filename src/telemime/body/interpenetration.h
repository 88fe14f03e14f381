// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/body/body.h"

namespace telemime {

/// How deep the arms are inside the chest, the head or each other: the sum over pairs of segments of the
/// depth (m) by which their inner capsules overlap. 0 for a pose without interpenetration. The capsules are
/// thinner than the surfaces, so that touching (a hand on the chest, clasped hands) is free.
double interpenetration(const Body& body, const Kinematics& kinematics);

/// Poses deeper than this (m) are invalid (thesis 2.4.1: no arm inside the chest).
inline constexpr double kInvalidInterpenetration = 0.02;

}  // namespace telemime
