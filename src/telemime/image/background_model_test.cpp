// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/background_model.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/core/random.h"
#include "telemime/image/light_change.h"

namespace telemime {
namespace {

/// A wall with a darker and a coloured patch, and noise.
cv::Mat scene(Random& random, double light = 1.0) {
  cv::Mat image(120, 160, CV_8UC3, cv::Scalar(150, 155, 160));
  image(cv::Rect(20, 20, 40, 30)).setTo(cv::Scalar(60, 90, 40));
  image(cv::Rect(90, 60, 30, 40)).setTo(cv::Scalar(40, 45, 50));
  cv::Mat out(image.size(), CV_8UC3);
  for (int i = 0; i < static_cast<int>(image.total()) * 3; ++i) {
    out.data[i] = cv::saturate_cast<unsigned char>(light * image.data[i] + random.normal(0, 1.5));
  }
  return out;
}

BackgroundModel learned(Random& random) {
  std::vector<cv::Mat> images;
  images.reserve(64);
  for (int i = 0; i < 20; ++i) {
    images.push_back(scene(random));
  }
  return learn_background_model(images);
}

/// Energy of an unknown colour: a pixel above it belongs to the person.
constexpr float kAnything = 3.0F;

cv::Mat foreground(const BackgroundModel& model, const cv::Mat& image) {
  LogColour colour = log_colour(image);
  compensate(model, estimate_light(model, colour, {}), colour);
  return background_energy(model, colour, ShadowRange{}).energy > kAnything;
}

double share(const cv::Mat& mask) {
  return cv::countNonZero(mask) / static_cast<double>(mask.total());
}

TEST(BackgroundModel, EmptySceneIsBackground) {
  Random random(1);
  const BackgroundModel model = learned(random);
  EXPECT_LT(share(foreground(model, scene(random))), 0.001);
}

TEST(BackgroundModel, LampIsNotForeground) {
  Random random(2);
  const BackgroundModel model = learned(random);
  EXPECT_LT(share(foreground(model, scene(random, 1.14))), 0.005);
  EXPECT_LT(share(foreground(model, scene(random, 0.75))), 0.005);
}

TEST(BackgroundModel, ShadowIsBackgroundBlackObjectIsNot) {
  Random random(3);
  const BackgroundModel model = learned(random);
  cv::Mat image = scene(random);
  const cv::Rect place(60, 5, 25, 25);
  cv::Mat(image(place) * 0.75).copyTo(image(place));
  EXPECT_LT(share(foreground(model, image)(place)), 0.02);
  image(place).setTo(cv::Scalar(20, 20, 22));
  EXPECT_GT(share(foreground(model, image)(place)), 0.99);
}

TEST(BackgroundModel, SkinOnGreyWallIsForeground) {
  Random random(4);
  const BackgroundModel model = learned(random);
  cv::Mat image = scene(random);
  const cv::Rect place(120, 10, 20, 40);
  image(place).setTo(cv::Scalar(120, 150, 200));
  const cv::Mat mask = foreground(model, image);
  EXPECT_GT(share(mask(place)), 0.99);
  EXPECT_LT(share(mask) - share(mask(place)) * place.area() / mask.total(), 0.002);
}

TEST(BackgroundModel, ExposureWhileLearningIsNoVariance) {
  Random random(9);
  std::vector<cv::Mat> images;
  for (int i = 0; i < 20; ++i) {
    images.push_back(scene(random, 1.0 + 0.02 * i));
  }
  const BackgroundModel model = learn_background_model(images);
  EXPECT_LT(cv::mean(model.luminance_variance)[0], 1.5 * cv::mean(learned(random).luminance_variance)[0]);
}

TEST(BackgroundModel, UnknownPixelsAreLearnedWhenSteady) {
  Random random(6);
  BackgroundModel model = learned(random);
  model.valid.colRange(0, 80).setTo(0);
  const LogColour colour = log_colour(scene(random));
  const cv::Mat unknown(120, 160, CV_32FC1, cv::Scalar(7));
  BackgroundEnergy energy = background_energy(model, colour, ShadowRange{});
  energy.shaded.setTo(255);
  set_unknown(model, unknown, energy);
  EXPECT_EQ(energy.energy.at<float>(60, 10), 7.0F);
  EXPECT_LT(energy.energy.at<float>(60, 100), 0.0F);
  EXPECT_EQ(cv::countNonZero(energy.shaded.colRange(0, 80)), 0);
  const cv::Mat everywhere(120, 160, CV_8UC1, cv::Scalar(255));
  adapt_background(model, colour, everywhere, 0.0F);
  EXPECT_EQ(model.valid.at<unsigned char>(60, 10), 0);
  for (int i = 0; i < 20; ++i) {
    adapt_background(model, log_colour(scene(random)), everywhere, 0.0F);
  }
  EXPECT_EQ(model.valid.at<unsigned char>(60, 10), 255);
}

TEST(BackgroundModel, AdaptsOnlyInsideTheMask) {
  Random random(7);
  BackgroundModel model = learned(random);
  const float before = model.mean.l.at<float>(5, 5);
  cv::Mat where = cv::Mat::zeros(120, 160, CV_8UC1);
  where.colRange(80, 160).setTo(255);
  const float other = model.mean.l.at<float>(5, 150);
  adapt_background(model, log_colour(scene(random, 1.3)), where, 0.5F);
  EXPECT_EQ(model.mean.l.at<float>(5, 5), before);
  EXPECT_GT(model.mean.l.at<float>(5, 150), other + 0.05F);
}

TEST(BackgroundModel, RefusesNoImagesAndUnequalSizes) {
  EXPECT_THROW(learn_background_model({}), Error);
  const std::vector<cv::Mat> unequal{cv::Mat(4, 4, CV_8UC3, cv::Scalar(1)),
                                     cv::Mat(5, 4, CV_8UC3, cv::Scalar(1))};
  EXPECT_THROW(learn_background_model(unequal), Error);
}

// What covered a pixel before has no part in its noise.
TEST(BackgroundModel, LearnedPixelsHaveTheirOwnNoise) {
  Random random(8);
  const std::vector<cv::Mat> black{cv::Mat(120, 160, CV_8UC3, cv::Scalar(20, 20, 20))};
  BackgroundModel model = learn_background_model(black);
  model.valid.setTo(0);
  const cv::Mat everywhere(120, 160, CV_8UC1, cv::Scalar(255));
  for (int i = 0; i < 20; ++i) {
    adapt_background(model, log_colour(scene(random)), everywhere, 0.0F);
  }
  const std::vector<cv::Mat> one{scene(random)};
  const BackgroundModel wall = learn_background_model(one);
  EXPECT_NEAR(cv::mean(model.chroma_variance)[0] / cv::mean(wall.chroma_variance)[0], 1.0, 0.05);
  EXPECT_NEAR(cv::mean(model.luminance_variance)[0] / cv::mean(wall.luminance_variance)[0], 1.0, 0.05);
}

TEST(BackgroundModel, PixelsAreLearnedWhenSteadyForSoLong) {
  Random random(9);
  const cv::Mat everywhere(120, 160, CV_8UC1, cv::Scalar(255));
  for (const int steady : {3, 12, 30, 255}) {
    BackgroundModel model = learned(random);
    model.valid.setTo(0);
    const LogColour colour = log_colour(scene(random));
    for (int i = 0; i < steady; ++i) {
      EXPECT_EQ(model.valid.at<unsigned char>(60, 10), 0) << steady;
      adapt_background(model, colour, everywhere, 0.0F, steady);
    }
    EXPECT_EQ(model.valid.at<unsigned char>(60, 10), 255) << steady;
  }
}

}  // namespace
}  // namespace telemime
