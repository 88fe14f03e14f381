// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "avatars/figure.h"
#include "avatars/surface.h"

namespace telemime {

/// Fewer triangles, whose vertices are some of those that there were: edges are collapsed (Garland and
/// Heckbert, SIGGRAPH 1997, by meshoptimizer) as long as the surface stays within about `error` (m). That is
/// measured on the figure with every joint bent, so that what has to bend keeps vertices for it.
void simplify(const Figure& figure, double error, Triangles& surface);

}  // namespace telemime
