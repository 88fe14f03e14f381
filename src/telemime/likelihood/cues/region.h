// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/likelihood/cues/reductions.h"

namespace telemime {

/// Non-overlapping ratio F in [0, 1] (thesis equation 2.5, mean over the classes): 0 when image and model
/// agree in every class, 1 when nothing overlaps. A class that is empty in both counts 0.
double non_overlapping_ratio(const Reductions& r);

}  // namespace telemime
