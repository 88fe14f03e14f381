// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/light_change.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "telemime/core/random.h"

namespace telemime {
namespace {

// Dark, medium, coloured and bright things; the grey levels are multiplied and shifted.
cv::Mat lit_scene(Random& random, const cv::Scalar& gain, const cv::Scalar& offset) {
  cv::Mat image(120, 160, CV_8UC3, cv::Scalar(120, 125, 130));
  image(cv::Rect(10, 10, 40, 40)).setTo(cv::Scalar(28, 24, 30));
  image(cv::Rect(60, 10, 40, 40)).setTo(cv::Scalar(230, 235, 225));
  image(cv::Rect(110, 10, 40, 40)).setTo(cv::Scalar(80, 60, 160));
  image(cv::Rect(10, 70, 60, 40)).setTo(cv::Scalar(60, 90, 50));
  for (std::size_t i = 0; i < image.total() * 3; ++i) {
    const int channel = static_cast<int>(i % 3);
    image.data[i] = cv::saturate_cast<unsigned char>(gain[channel] * image.data[i] + offset[channel] +
                                                     random.normal(0, 1.5));
  }
  return image;
}

BackgroundModel learned_at(Random& random, double gain) {
  const std::vector<cv::Mat> images(3, lit_scene(random, cv::Scalar::all(gain), {}));
  return learn_background_model(images);
}

// Share of the pixels that are no background, as far as energies tell.
double foreground_share(const BackgroundModel& model, const cv::Mat& image) {
  constexpr float kAnything = 3.0F;
  LogColour colour = log_colour(image);
  compensate(model, estimate_light(model, colour, {}), colour);
  const cv::Mat energy = background_energy(model, colour, ShadowRange{}).energy;
  return cv::countNonZero(energy > kAnything) / static_cast<double>(energy.total());
}

TEST(LightChange, ExposureIsNotForeground) {
  // Of dark and white things, too: neither the offset of the logarithms nor clipping matters.
  Random random(1);
  for (const double then : {0.7, 1.0, 1.4}) {
    const BackgroundModel model = learned_at(random, then);
    for (const double now : {0.6, 0.8, 1.3, 1.7}) {
      // Brightening makes the noise of dark things stand out.
      EXPECT_LT(foreground_share(model, lit_scene(random, cv::Scalar::all(now), {})), 0.015)
          << then << " " << now;
    }
  }
}

TEST(LightChange, BrightnessAndTintAreNotForeground) {
  Random random(2);
  const BackgroundModel model = learned_at(random, 1.0);
  for (const double offset : {-55.0, -20.0, 25.0, 50.0}) {
    EXPECT_LT(foreground_share(model, lit_scene(random, cv::Scalar::all(1.0), cv::Scalar::all(offset))), 0.01)
        << offset;
  }
  EXPECT_LT(foreground_share(model, lit_scene(random, {1.14, 1.05, 0.9}, {10, 5, 15})), 0.01);
}

TEST(LightChange, GainIsMeasuredOnTheBackground) {
  Random random(3);
  const BackgroundModel model = learned_at(random, 1.0);
  const LogColour image = log_colour(lit_scene(random, cv::Scalar::all(1.2), {}));
  cv::Mat believed(120, 160, CV_8UC1, cv::Scalar(255));
  const LightChange light = estimate_light(model, image, believed);
  EXPECT_NEAR(cv::mean(light.gain.l)[0], std::log(1.2), 0.01);
  EXPECT_NEAR(cv::mean(light.gain.u)[0], 0.0, 0.01);
  believed.setTo(0);
  EXPECT_EQ(cv::norm(estimate_light(model, image, believed).gain.l, cv::NORM_INF), 0.0);
}

TEST(LightChange, OffsetIsMeasuredAndZeroForAGain) {
  Random random(4);
  const BackgroundModel model = learned_at(random, 1.0);
  const LightChange gain = estimate_light(model, log_colour(lit_scene(random, {1.3, 1.2, 1.1}, {})), {});
  EXPECT_EQ(gain.offset, (std::array<float, 3>{}));
  const LightChange none = estimate_light(model, log_colour(lit_scene(random, cv::Scalar::all(1.0), {})), {});
  EXPECT_EQ(none.offset, (std::array<float, 3>{}));
  const LightChange both =
      estimate_light(model, log_colour(lit_scene(random, {0.8, 0.8, 0.8}, {40, 30, 20})), {});
  EXPECT_NEAR(both.offset[0], 40, 3);
  EXPECT_NEAR(both.offset[2], 20, 3);
  EXPECT_NEAR(cv::mean(both.gain.l)[0], std::log(0.8), 0.04);
}

TEST(LightChange, SomebodyInFrontDoesNotMatter) {
  Random random(5);
  const BackgroundModel model = learned_at(random, 1.0);
  cv::Mat image = lit_scene(random, cv::Scalar::all(1.0), cv::Scalar::all(30));
  image(cv::Rect(60, 40, 40, 80)).setTo(cv::Scalar(40, 30, 120));
  const LightChange light = estimate_light(model, log_colour(image), {});
  EXPECT_NEAR(light.offset[1], 30, 4);
}

TEST(LightChange, PlainWallHasNoOffset) {
  Random random(6);
  const std::vector<cv::Mat> wall{cv::Mat(120, 160, CV_8UC3, cv::Scalar(140, 140, 140))};
  const BackgroundModel model = learn_background_model(wall);
  const cv::Mat brighter(120, 160, CV_8UC3, cv::Scalar(168, 168, 168));
  const LightChange light = estimate_light(model, log_colour(brighter), {});
  EXPECT_EQ(light.offset, (std::array<float, 3>{}));
  EXPECT_NEAR(cv::mean(light.gain.l)[0], std::log(1.2), 0.005);
}

}  // namespace
}  // namespace telemime
