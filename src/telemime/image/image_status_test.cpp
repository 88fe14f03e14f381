// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/image_status.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "telemime/core/random.h"

namespace telemime {
namespace {

ImageStatus good_status() {
  ImageStatus status;
  status.person = true;
  status.people = 1;
  status.brightness = 120;
  status.skin_share = 0.3;
  return status;
}

PersonColours known_colours() {
  PersonColours colours;
  colours.skin = {ColourGaussian{}};
  return colours;
}

bool says(const ImageStatus& status, const std::string& words,
          const PersonColours& colours = known_colours()) {
  const auto warnings = warnings_of(status, colours);
  return std::any_of(warnings.begin(), warnings.end(),
                     [&](const auto& w) { return w.find(words) != std::string::npos; });
}

TEST(ImageStatus, EachViolatedAssumptionHasAWarning) {
  EXPECT_TRUE(warnings_of(good_status(), known_colours()).empty());
  ImageStatus status = good_status();
  status.camera_motion = 1;
  EXPECT_TRUE(says(status, "camera moves slightly"));
  status.camera_motion = 2;
  EXPECT_TRUE(says(status, "camera moves, so the background model cannot be used"));
  status.skin_share = 0.02;
  EXPECT_TRUE(says(status, "long sleeves"));
  status.light_change = -0.3;
  EXPECT_TRUE(says(status, "the image is 74 % as bright"));
  status.brightness = 30;
  EXPECT_TRUE(says(status, "turn on a light"));
  status.white_share = 0.25;
  EXPECT_TRUE(says(status, "overexposed (25 % of the head is white)"));
  status.people = 2;
  EXPECT_TRUE(says(status, "2 people"));
  status.person = false;
  EXPECT_TRUE(says(status, "no person"));
  ColourGaussian white;
  ColourGaussian blue;
  white.weight = blue.weight = 0.5F;
  blue.mean = {-0.4F, 0.5F, 4.0F};
  PersonColours colours = known_colours();
  colours.clothes = {white, blue};
  EXPECT_TRUE(says(status, "several colours", colours));
}

TEST(ImageStatus, OnlyTheCauseIsNamed) {
  // In a black image, or behind a hand, nobody is visible and nothing has a colour: that is no other fault.
  ImageStatus status = good_status();
  status.person = false;
  status.coloured_share = 0;
  status.brightness = 3;
  EXPECT_EQ(warnings_of(status, known_colours()).size(), 1U);
  EXPECT_TRUE(says(status, "is the lens covered?"));
  status.brightness = 80;
  status.detail = 1;
  EXPECT_EQ(warnings_of(status, known_colours()).size(), 1U);
  EXPECT_TRUE(says(status, "in front of the lens"));
}

TEST(ImageStatus, GreyPictureHasNoColour) {
  ImageStatus status = good_status();
  status.coloured_share = 0.0;
  EXPECT_TRUE(says(status, "no colour"));
  status.skin_share = 0.0;
  EXPECT_FALSE(says(status, "sleeves")) << "skin that cannot be told from clothes is no long sleeve";
  status.person = false;
  EXPECT_FALSE(says(status, "no colour")) << "an empty white room";
}

TEST(ImageStatus, WhiteIsWhatHasNoColourLeft) {
  cv::Mat image(20, 20, CV_8UC3, cv::Scalar(235, 240, 255));  // bright skin
  image(cv::Rect(0, 0, 10, 10)).setTo(cv::Scalar::all(253));
  cv::Mat mask = cv::Mat::zeros(image.size(), CV_8UC1);
  EXPECT_EQ(white_share_of(image, mask), 0.0);
  mask.setTo(255);
  EXPECT_DOUBLE_EQ(white_share_of(image, mask), 0.25);
  mask(cv::Rect(10, 0, 10, 20)).setTo(0);
  EXPECT_DOUBLE_EQ(white_share_of(image, mask), 0.5);
}

// A room of grey furniture with noise; the channels have these gains.
cv::Mat grey_room(const cv::Scalar& gains) {
  Random random(1);
  cv::Mat image(120, 160, CV_8UC3, cv::Scalar(110, 110, 110));
  for (int i = 0; i < 12; ++i) {
    image(cv::Rect(4 + 13 * i, 8 + (i * 7) % 60, 9, 30)).setTo(cv::Scalar::all(20 * i));
  }
  for (int r = 0; r < image.rows; ++r) {
    for (int c = 0; c < image.cols; ++c) {
      for (int channel = 0; channel < 3; ++channel) {
        auto& value = image.at<cv::Vec3b>(r, c)[channel];
        value = cv::saturate_cast<unsigned char>(gains[channel] * value + random.normal(0, 1));
      }
    }
  }
  return image;
}

TEST(ColouredShare, IsZeroForGreyAndTintedPictures) {
  EXPECT_LT(coloured_share_of(grey_room({1, 1, 1})), 0.002);
  EXPECT_LT(coloured_share_of(grey_room({0.9, 1, 0.95})), 0.002);
  cv::Mat with_face = grey_room({1, 1, 1});
  cv::ellipse(with_face, {80, 50}, {9, 12}, 0, 0, 360, cv::Scalar(120, 150, 200), cv::FILLED);
  EXPECT_GT(coloured_share_of(with_face), 0.01);
  EXPECT_EQ(coloured_share_of(cv::Mat::zeros(120, 160, CV_8UC3)), 0.0);
}

TEST(Detail, IsThatOfARoomAndNotOfAHand) {
  cv::Mat room;
  cv::cvtColor(grey_room({1, 1, 1}), room, cv::COLOR_BGR2GRAY);
  EXPECT_GT(detail_of(room), 15);
  // A hand on the lens: a dim red glow, with noise.
  Random random(2);
  cv::Mat hand(480, 640, CV_8UC1);
  for (int r = 0; r < hand.rows; ++r) {
    for (int c = 0; c < hand.cols; ++c) {
      hand.at<unsigned char>(r, c) = cv::saturate_cast<unsigned char>(20 + 0.15 * c + random.normal(0, 4));
    }
  }
  EXPECT_LT(detail_of(hand), 4);
}

}  // namespace
}  // namespace telemime
