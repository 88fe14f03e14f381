// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/hue_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

/// Half the pixels a little on one side of red, half on the other.
cv::Mat reds() {
  cv::Mat image(10, 10, CV_8UC3, cv::Scalar(40, 30, 200));
  image.rowRange(0, 5).setTo(cv::Scalar(30, 40, 200));
  return image;
}

const cv::Mat kAll(10, 10, CV_8UC1, cv::Scalar(255));

TEST(HueModel, RedIsOneColourAcrossTheEndOfTheScale) {
  const HueModel model = learn_hue(reds(), kAll);
  EXPECT_LT(std::abs(std::remainder(model.hue, 2 * std::numbers::pi)), 0.02);
  EXPECT_TRUE(model.coloured);
  double worst = 0;
  cv::minMaxLoc(hue_distance2(model, reds()), nullptr, &worst);
  EXPECT_LT(worst, 4);
}

TEST(HueModel, OtherHuesAreFar) {
  const HueModel model = learn_hue(reds(), kAll);
  double nearest = 0;
  cv::minMaxLoc(hue_distance2(model, cv::Mat(4, 4, CV_8UC3, cv::Scalar(30, 200, 40))), &nearest);
  EXPECT_GT(nearest, 100);
}

TEST(HueModel, GreyHasNoHue) {
  EXPECT_FALSE(learn_hue(cv::Mat(10, 10, CV_8UC3, cv::Scalar(99, 100, 101)), kAll).coloured);
}

TEST(HueModel, NeedsSamples) {
  EXPECT_THROW(learn_hue(reds(), cv::Mat::zeros(10, 10, CV_8UC1)), Error);
}

}  // namespace
}  // namespace telemime
