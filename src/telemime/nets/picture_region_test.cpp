// SPDX-License-Identifier: Apache-2.0
#include "telemime/nets/picture_region.h"

#include <gtest/gtest.h>

#include <numbers>
#include <opencv2/core.hpp>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

// Blue is the column, green the row, red 7.
cv::Mat coordinates(int width, int height) {
  cv::Mat picture(height, width, CV_8UC3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      picture.at<cv::Vec3b>(y, x) = cv::Vec3b(static_cast<std::uint8_t>(x), static_cast<std::uint8_t>(y), 7);
    }
  }
  return picture;
}

const InputFormat kBytes{.size = {8, 6}, .black = 0.0F, .white = 255.0F};

TEST(PictureRegion, OwnCoordinatesGoFromEdgeToEdge) {
  const PictureRegion region{.centre = {3.5, 2.5}, .width = 8.0, .height = 6.0};
  EXPECT_TRUE(region.pixel({0.0, 0.0}).isApprox(Eigen::Vector2d(-0.5, -0.5)));
  EXPECT_TRUE(region.pixel({1.0, 1.0}).isApprox(Eigen::Vector2d(7.5, 5.5)));
}

TEST(PictureRegion, SquareContainsAWidePicture) {
  const PictureRegion region = square_around(cv::Mat(6, 8, CV_8UC3));
  EXPECT_TRUE(region.pixel({0.0, 0.0}).isApprox(Eigen::Vector2d(-0.5, -1.5)));
  EXPECT_TRUE(region.pixel({1.0, 1.0}).isApprox(Eigen::Vector2d(7.5, 6.5)));
}

TEST(PictureRegion, QuarterTurnByHand) {
  const PictureRegion region{
      .centre = {10.0, 20.0}, .width = 4.0, .height = 4.0, .angle = 0.5 * std::numbers::pi};
  // Clockwise as seen: the right of the region points down in the picture.
  EXPECT_TRUE(region.pixel({1.0, 0.5}).isApprox(Eigen::Vector2d(10.0, 22.0)));
}

TEST(PictureRegion, UprightAxisHasNoAngle) {
  const PictureRegion region = region_of_axis({50.0, 80.0}, {50.0, 40.0});
  EXPECT_NEAR(region.angle, 0.0, 1e-12);
  EXPECT_NEAR(region.width, 100.0, 1e-9);
  EXPECT_NEAR(region_of_axis({50.0, 80.0}, {90.0, 80.0}).angle, 0.5 * std::numbers::pi, 1e-12);
}

TEST(NetworkInput, WholePictureIsItselfAsRgb) {
  const PictureRegion whole{.centre = {3.5, 2.5}, .width = 8.0, .height = 6.0};
  const std::vector<float> input = network_input(coordinates(8, 6), whole, kBytes);
  ASSERT_EQ(input.size(), 8U * 6U * 3U);
  constexpr std::size_t kPixel = 3U * (2U * 8U + 5U);  // row 2, column 5
  EXPECT_FLOAT_EQ(input[kPixel], 7.0F);
  EXPECT_FLOAT_EQ(input[kPixel + 1], 2.0F);
  EXPECT_FLOAT_EQ(input[kPixel + 2], 5.0F);
}

TEST(NetworkInput, BorderIsRepeatedOrBlack) {
  const cv::Mat picture(4, 4, CV_8UC3, cv::Scalar(255, 255, 255));
  const PictureRegion region{.centre = {1.5, 1.5}, .width = 12.0, .height = 12.0};
  InputFormat format{.size = {12, 12}, .black = -1.0F, .white = 1.0F};
  EXPECT_FLOAT_EQ(network_input(picture, region, format)[0], 1.0F);
  format.repeats_border = false;
  EXPECT_FLOAT_EQ(network_input(picture, region, format)[0], -1.0F);
}

TEST(NetworkInput, RefusesOtherPictures) {
  EXPECT_THROW(network_input(cv::Mat(), PictureRegion{}, kBytes), Error);
  const cv::Mat grey(4, 4, CV_8UC1, cv::Scalar(9));
  EXPECT_THROW(network_input(grey, square_around(grey), kBytes), Error);
}

TEST(PictureMask, RowsThatThePictureShows) {
  // Ten rows of the grid over 20 rows of the picture, from row 10 on: two in each row of the grid.
  const PictureRegion region{.centre = {9.5, 19.5}, .width = 20.0, .height = 20.0};
  const cv::Range all = rows_in_picture(region, {10, 10}, {20, 40});
  EXPECT_EQ(all, cv::Range(0, 10));
  const cv::Range upper = rows_in_picture(region, {10, 10}, {20, 14});
  EXPECT_EQ(upper.start, 0);
  EXPECT_GE(upper.end, 3);
  EXPECT_LE(upper.end, 5);
  EXPECT_TRUE(rows_in_picture(region, {10, 10}, {20, 4}).empty());
}

TEST(PictureMask, CoversTheRegionAlone) {
  const cv::Mat cells(4, 4, CV_8UC1, cv::Scalar(255));
  const PictureRegion region{.centre = {9.5, 9.5}, .width = 8.0, .height = 8.0};
  const cv::Mat mask = picture_mask(cells, region, {20, 20});
  EXPECT_EQ(mask.at<std::uint8_t>(9, 9), 255);
  EXPECT_EQ(mask.at<std::uint8_t>(2, 9), 0);
  EXPECT_NEAR(cv::sum(mask)[0] / 255.0, 64.0, 1.0);
}

}  // namespace
}  // namespace telemime
