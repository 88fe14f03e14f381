// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/visible_line.h"

#include <gtest/gtest.h>

namespace telemime {
namespace {

TEST(VisibleLine, ReachesToTheBorder) {
  const Camera camera;  // 640x480, from -0.5 to 639.5 and 479.5
  EXPECT_EQ(share_in_image(camera, {10.0, 20.0}, {600.0, 400.0}), 1.0);
  EXPECT_EQ(share_in_image(camera, {10.0, 20.0}, {10.0, 20.0}), 1.0);
  EXPECT_NEAR(share_in_image(camera, {599.5, 20.0}, {679.5, 20.0}), 0.5, 1e-12);
  EXPECT_NEAR(share_in_image(camera, {9.5, 20.0}, {-30.5, 60.0}), 0.25, 1e-12);
  EXPECT_NEAR(share_in_image(camera, {9.5, 469.5}, {-30.5, 489.5}), 0.25, 1e-12) << "the nearer border";
}

TEST(VisibleLine, IsNothingWhereItBeginsOutside) {
  EXPECT_EQ(share_in_image(Camera{}, {-30.5, 60.0}, {9.5, 20.0}), 0.0);
  EXPECT_EQ(share_in_image(Camera{}, {30.0, 480.0}, {30.0, 500.0}), 0.0);
}

}  // namespace
}  // namespace telemime
