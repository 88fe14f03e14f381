// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/deriche.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

cv::Mat ramp(float slope_x, float slope_y) {
  cv::Mat image(60, 80, CV_32FC1);
  for (int r = 0; r < image.rows; ++r) {
    for (int c = 0; c < image.cols; ++c) {
      image.at<float>(r, c) = slope_x * static_cast<float>(c) + slope_y * static_cast<float>(r);
    }
  }
  return image;
}

class DericheAlpha : public testing::TestWithParam<double> {};

TEST_P(DericheAlpha, RampGivesItsSlope) {
  const Gradient g = deriche_gradient(ramp(2.0F, -3.0F), GetParam());
  EXPECT_NEAR(g.dx.at<float>(30, 40), 2.0, 0.02);
  EXPECT_NEAR(g.dy.at<float>(30, 40), -3.0, 0.03);
}

TEST_P(DericheAlpha, ConstantGivesZeroUpToTheBorders) {
  const Gradient g = deriche_gradient(cv::Mat(20, 30, CV_8UC1, cv::Scalar(200)), GetParam());
  EXPECT_LT(cv::norm(g.dx, cv::NORM_INF), 2e-3);
  EXPECT_LT(cv::norm(g.dy, cv::NORM_INF), 2e-3);
}

TEST_P(DericheAlpha, EqualsDirectConvolution) {
  const double alpha = GetParam();
  const double q = std::exp(-alpha);
  cv::Mat image(1, 81, CV_32FC1, cv::Scalar(0));
  image.at<float>(0, 40) = 100.0F;
  const Gradient g = deriche_gradient(image, alpha);
  // One row: smoothing along y changes nothing, so dx is the impulse response of the derivative.
  const double k = std::pow(1 - q, 3) / (2 * q * (1 + q));
  for (int n = -10; n <= 10; ++n) {
    const double expected = -100.0 * k * n * std::pow(q, std::abs(n));
    EXPECT_NEAR(g.dx.at<float>(0, 40 + n), expected, 2e-3) << "at offset " << n;
  }
}

INSTANTIATE_TEST_SUITE_P(SmoothToSharp, DericheAlpha, testing::Values(0.5, 1.0, 1.2, 3.0));

TEST(Deriche, TransposedImageSwapsDerivatives) {
  cv::Mat image(40, 50, CV_32FC1);
  for (int r = 0; r < image.rows; ++r) {
    for (int c = 0; c < image.cols; ++c) {
      image.at<float>(r, c) = static_cast<float>((r * 37 + c * 61) % 97);
    }
  }
  cv::Mat turned;
  cv::transpose(image, turned);
  const Gradient a = deriche_gradient(image, 1.0);
  const Gradient b = deriche_gradient(turned, 1.0);
  cv::Mat back;
  cv::transpose(b.dy, back);
  EXPECT_LT(cv::norm(a.dx, back, cv::NORM_INF), 1e-3);
}

TEST(Deriche, RefusesEmptyAndColourImages) {
  EXPECT_THROW(deriche_gradient(cv::Mat(), 1.0), Error);
  EXPECT_THROW(deriche_gradient(cv::Mat(4, 4, CV_8UC3), 1.0), Error);
  EXPECT_THROW(deriche_gradient(cv::Mat(4, 4, CV_8UC1), 0.0), Error);
}

}  // namespace
}  // namespace telemime
