// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "telemime/tracking/heuristics/heuristic.h"

namespace telemime {

/// Makes a particle of each pose that explains the landmarks of the frame: fitted from the prediction, from
/// scratch, and their mirror images in depth; the likeliest are searched further by all cues. Does nothing in
/// a frame without landmarks.
void search_landmarks(const FilterContext& context, Generation& generation);

}  // namespace telemime
