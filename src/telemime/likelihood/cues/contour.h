// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/likelihood/cues/reductions.h"

namespace telemime {

/// Mean edge distance D_C in pixels of the working image (thesis equation 3.13): the mean of the capped
/// distance map over the visible occluding contour. A model without a visible contour scores `cap`.
double mean_edge_distance(const Reductions& r, double cap);

}  // namespace telemime
