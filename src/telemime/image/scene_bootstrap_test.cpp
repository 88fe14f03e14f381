// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/scene_bootstrap.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "telemime/core/random.h"

namespace telemime {
namespace {

cv::Mat empty_scene(Random& random) {
  cv::Mat image(120, 160, CV_8UC3, cv::Scalar(150, 150, 140));
  image(cv::Rect(0, 0, 160, 30)).setTo(cv::Scalar(90, 120, 60));
  for (int i = 0; i < 12; ++i) {
    image(cv::Rect(4 + 13 * i, 8 + (i * 7) % 60, 6, 9)).setTo(cv::Scalar(20 * i, 60, 200 - 12 * i));
  }
  cv::Mat noise(image.size(), CV_8UC3);
  for (std::size_t i = 0; i < image.total() * 3; ++i) {
    image.data[i] = cv::saturate_cast<unsigned char>(image.data[i] + random.normal(0, 1));
  }
  return image;
}

HeadRegion head_at(int x) {
  HeadRegion head;
  head.centre = {x, 40};
  head.radii = {9, 13};
  return head;
}

cv::Mat with_person(cv::Mat image, int x) {
  cv::rectangle(image, cv::Rect(x - 24, 58, 48, 62), cv::Scalar(40, 30, 120), cv::FILLED);
  cv::rectangle(image, cv::Rect(x - 5, 50, 10, 12), cv::Scalar(120, 150, 200), cv::FILLED);
  cv::ellipse(image, {x, 40}, {9, 13}, 0, 0, 360, cv::Scalar(120, 150, 200), cv::FILLED);
  return image;
}

TEST(StillStretch, IsEmptyStartWithoutLastFrames) {
  Random random(1);
  std::vector<cv::Mat> clip;
  clip.reserve(64);
  for (int i = 0; i < 20; ++i) {
    clip.push_back(empty_scene(random));
  }
  for (int i = 0; i < 20; ++i) {
    clip.push_back(with_person(empty_scene(random), 150 - 4 * i));
  }
  const auto [first, count] = find_still_stretch(clip);
  EXPECT_EQ(first, 0U);
  EXPECT_EQ(count, 17U);
}

TEST(StillStretch, IsFoundAtTheEnd) {
  Random random(2);
  std::vector<cv::Mat> clip;
  clip.reserve(64);
  for (int i = 0; i < 15; ++i) {
    clip.push_back(with_person(empty_scene(random), 40 + 5 * i));
  }
  for (int i = 0; i < 15; ++i) {
    clip.push_back(empty_scene(random));
  }
  const auto [first, count] = find_still_stretch(clip);
  EXPECT_EQ(first, 18U);
  EXPECT_EQ(count, 12U);
}

TEST(StillStretch, NoneInAMovingClip) {
  Random random(3);
  std::vector<cv::Mat> clip;
  clip.reserve(64);
  for (int i = 0; i < 30; ++i) {
    clip.push_back(with_person(empty_scene(random), 20 + 4 * i));
  }
  EXPECT_EQ(find_still_stretch(clip).second, 0U);
}

TEST(AroundPerson, MovingPersonUncoversBackground) {
  Random random(4);
  std::vector<SceneSample> samples;
  samples.reserve(64);
  for (int i = 0; i < 12; ++i) {
    const int x = 30 + 9 * i;
    samples.push_back({with_person(empty_scene(random), x), head_at(x)});
  }
  const BackgroundModel model = learn_around_person(samples);
  const LogColour empty = log_colour(empty_scene(random));
  EXPECT_GT(cv::countNonZero(model.valid), 0.9 * model.valid.total());
  const cv::Mat wrong = (cv::abs(model.mean.l - empty.l) > 0.15) & model.valid;
  EXPECT_LT(cv::countNonZero(wrong), 0.02 * wrong.total());
}

TEST(AroundPerson, AlwaysCoveredPixelsStayUnknown) {
  Random random(5);
  std::vector<SceneSample> samples;
  samples.reserve(64);
  for (int i = 0; i < 8; ++i) {
    samples.push_back({with_person(empty_scene(random), 80), head_at(80)});
  }
  const BackgroundModel model = learn_around_person(samples);
  EXPECT_EQ(model.valid.at<unsigned char>(100, 80), 0);
  EXPECT_EQ(model.valid.at<unsigned char>(40, 80), 0);
  EXPECT_EQ(model.valid.at<unsigned char>(100, 10), 255);
  const ColourMixture surroundings = learn_surroundings(samples);
  ASSERT_FALSE(surroundings.empty());
  EXPECT_LT(mahalanobis2(surroundings, log_colour_of(150, 150, 140)), 9);
  EXPECT_GT(mahalanobis2(surroundings, log_colour_of(40, 30, 120)), 25);
}

TEST(SceneMotion, MeasuresShiftAndIsZeroAtRest) {
  Random random(6);
  cv::Mat grey;
  cv::cvtColor(empty_scene(random), grey, cv::COLOR_BGR2GRAY);
  const cv::Mat everywhere(grey.size(), CV_8UC1, cv::Scalar(255));
  cv::Mat moved;
  const cv::Matx23d by(1, 0, 3, 0, 1, 0);
  cv::warpAffine(grey, moved, by, grey.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  const auto motion = scene_motion(grey, moved, everywhere);
  ASSERT_TRUE(motion.has_value());
  EXPECT_NEAR(*motion, 3.0, 0.5);
  EXPECT_LT(scene_motion(grey, grey, everywhere).value_or(9), 0.01);
  EXPECT_FALSE(scene_motion(cv::Mat(60, 80, CV_8UC1, cv::Scalar(9)), cv::Mat(60, 80, CV_8UC1, cv::Scalar(9)),
                            cv::Mat(60, 80, CV_8UC1, cv::Scalar(255)))
                   .has_value());
}

}  // namespace
}  // namespace telemime
