// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/cues/contour.h"

namespace telemime {

double mean_edge_distance(const Reductions& r, double cap) {
  return r.contour_points > 0 ? r.contour_sum / r.contour_points : cap;
}

}  // namespace telemime
