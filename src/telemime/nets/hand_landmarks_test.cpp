// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/hand_landmarks.h"

#include <gtest/gtest.h>

#include <tuple>

namespace telemime {
namespace {

// As MediaPipe's hand_landmarks_to_roi: twice the longer side of the palm and middle joints, a tenth of their
// extent along the hand nearer to the fingertips.
TEST(HandLandmarks, NextSquareIsThatOfMediaPipe) {
  HandLandmarks hand;
  for (auto& point : hand.points) {
    point.pixel = {100.0, 150.0};
  }
  for (const auto& [index, x, y] : {std::tuple(0, 100.0, 200.0),
                                    {3, 60.0, 160.0},
                                    {17, 130.0, 150.0},
                                    {10, 100.0, 110.0},
                                    {6, 80.0, 112.0},
                                    {14, 120.0, 112.0},
                                    {12, 100.0, 40.0}}) {
    hand.points[static_cast<std::size_t>(index)].pixel = {x, y};
  }
  const PictureRegion square = next_region(hand);
  EXPECT_NEAR(square.width, 2.0 * 90.0, 1e-9);
  EXPECT_EQ(square.width, square.height);
  EXPECT_NEAR(square.angle, 0.0, 1e-9);
  EXPECT_NEAR(square.centre.x(), 95.0, 1e-9);
  EXPECT_NEAR(square.centre.y(), 155.0 - 9.0, 1e-9);
}

}  // namespace
}  // namespace telemime
