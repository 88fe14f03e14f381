// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/picture.h"

#include <gtest/gtest.h>

#include <limits>

#include "telemime/capture/testing.h"
#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

void expect_uniform(const cv::Mat& image, const cv::Vec3b& colour) {
  ASSERT_EQ(image.type(), CV_8UC3);
  ASSERT_EQ(image.size(), cv::Size(5, 3));
  for (int y = 0; y < image.rows; ++y) {
    for (int x = 0; x < image.cols; ++x) {
      ASSERT_EQ(image.at<cv::Vec3b>(y, x), colour);
    }
  }
}

TEST(ToBgr8, ConvertsGreyAlpha16BitAndFloats) {
  const cv::Size size(5, 3);
  expect_uniform(to_bgr8(cv::Mat(size, CV_8UC1, cv::Scalar(70))), {70, 70, 70});
  expect_uniform(to_bgr8(cv::Mat(size, CV_8UC3, cv::Scalar(1, 2, 3))), {1, 2, 3});
  expect_uniform(to_bgr8(cv::Mat(size, CV_8UC4, cv::Scalar(1, 2, 3, 99))), {1, 2, 3});
  expect_uniform(to_bgr8(cv::Mat(size, CV_16UC1, cv::Scalar(65535))), {255, 255, 255});
  expect_uniform(to_bgr8(cv::Mat(size, CV_16UC3, cv::Scalar(257, 514, 771))), {1, 2, 3});
  expect_uniform(to_bgr8(cv::Mat(size, CV_16UC4, cv::Scalar(257, 514, 771, 0))), {1, 2, 3});
  expect_uniform(to_bgr8(cv::Mat(size, CV_32FC1, cv::Scalar(0.2))), {51, 51, 51});
}

TEST(ToBgr8, AnythingElseIsEmpty) {
  EXPECT_TRUE(to_bgr8(cv::Mat()).empty());
  EXPECT_TRUE(to_bgr8(cv::Mat(3, 3, CV_8UC2)).empty());
  EXPECT_TRUE(to_bgr8(cv::Mat(3, 3, CV_MAKETYPE(CV_8U, 7))).empty());
}

TEST(FitTo, ResizesWithOneNote) {
  Notes notes;
  const cv::Mat image = testing::numbered_picture(3, {64, 48});
  EXPECT_EQ(fit_to(image, {64, 48}, notes).data, image.data);
  EXPECT_TRUE(notes.text().empty());
  EXPECT_EQ(fit_to(image, {32, 24}, notes).size(), cv::Size(32, 24));
  const std::string once = notes.text();
  EXPECT_NE(once.find("32x24"), std::string::npos) << once;
  EXPECT_EQ(testing::number_of(fit_to(image, {32, 24}, notes)), 3);
  EXPECT_EQ(notes.text(), once);
}

TEST(UsableFps, ReplacesUnusableFrameRatesWithANote) {
  for (const double fps : {0.5, 1.0, 14.985, 25.0, 29.97, 240.0, 1000.0}) {
    for (const std::optional<double> measured : {std::optional<double>(), std::optional(1.01 * fps)}) {
      Notes notes;
      EXPECT_EQ(usable_fps(fps, measured, notes), fps);
      EXPECT_TRUE(notes.text().empty());
    }
    Notes notes;
    EXPECT_EQ(usable_fps(fps, 0.9 * fps, notes), 0.9 * fps) << "the time stamps are believed";
    EXPECT_FALSE(notes.text().empty());
    EXPECT_EQ(usable_fps(fps, 90000.0, notes), fps) << "but not as ticks of a clock";
  }
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double fps : {0.0, -25.0, 1e-9, 90000.0, nan, infinite, -infinite}) {
    Notes notes;
    EXPECT_EQ(usable_fps(fps, std::nullopt, notes), 25.0) << fps;
    EXPECT_NE(notes.text().find("25"), std::string::npos) << fps;
    EXPECT_EQ(usable_fps(fps, 30.0, notes), 30.0) << fps;
    EXPECT_EQ(usable_fps(fps, 90000.0, notes), 25.0) << fps;
  }
}

TEST(WithSquarePixels, ThePictureHasItsShownAspect) {
  const cv::Mat stored = testing::numbered_picture(3, {480, 480});
  EXPECT_EQ(with_square_pixels(stored, 1.0).size(), stored.size());
  EXPECT_EQ(with_square_pixels(stored, 4.0 / 3.0).size(), cv::Size(640, 480));
  EXPECT_EQ(with_square_pixels(stored, 0.5).size(), cv::Size(480, 960));
  EXPECT_TRUE(with_square_pixels({}, 2.0).empty());
}

TEST(RequireUsableSize, RefusesImagesTooSmallForAPerson) {
  EXPECT_NO_THROW(require_usable_size({16, 16}, "x"));
  for (const cv::Size size : {cv::Size(1, 1), cv::Size(640, 15), cv::Size(3, 480), cv::Size(0, 0)}) {
    EXPECT_NE(error_of(ErrorKind::input, [&] { require_usable_size(size, "x.png"); }).find("x.png"),
              std::string::npos);
  }
}

TEST(Picture, OtherAspectRatiosGetBlackBars) {
  Notes notes;
  const cv::Mat wide(36, 64, CV_8UC3, cv::Scalar::all(200));
  const cv::Mat fitted = fit_to(wide, {32, 24}, notes);
  EXPECT_EQ(fitted.size(), cv::Size(32, 24));
  EXPECT_EQ(cv::mean(fitted.rowRange(0, 3))[0], 0.0);
  EXPECT_EQ(cv::mean(fitted.rowRange(3, 21))[0], 200.0) << "18 of 24 rows, as 36 are of 48";
  EXPECT_EQ(cv::mean(fitted.rowRange(21, 24))[0], 0.0);
  const cv::Mat high = fit_to(wide.t(), {32, 24}, notes);
  EXPECT_EQ(cv::mean(high.col(0))[0], 0.0);
  EXPECT_EQ(cv::mean(high.col(16))[0], 200.0);
  EXPECT_EQ(fit_to(cv::Mat(1, 5000, CV_8UC3), {32, 24}, notes).size(), cv::Size(32, 24));
}

TEST(Picture, AspectRatiosAreEqualUpToRounding) {
  EXPECT_TRUE(same_shape({640, 480}, {320, 240}));
  EXPECT_TRUE(same_shape({854, 480}, {1280, 720}));
  EXPECT_FALSE(same_shape({640, 480}, {640, 360}));
  EXPECT_FALSE(same_shape({640, 480}, {480, 640}));
}

}  // namespace
}  // namespace telemime
