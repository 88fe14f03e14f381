// SPDX-License-Identifier: Apache-2.0
#include "telemime/likelihood/cues/contour.h"

#include <gtest/gtest.h>

namespace telemime {
namespace {

TEST(ContourCue, IsTheMeanDistanceOrTheCap) {
  Reductions r;
  r.contour_sum = 30.0;
  r.contour_points = 12;
  EXPECT_EQ(mean_edge_distance(r, 10.0), 2.5);
  EXPECT_EQ(mean_edge_distance(Reductions{}, 7.5), 7.5) << "a model without contour";
}

}  // namespace
}  // namespace telemime
