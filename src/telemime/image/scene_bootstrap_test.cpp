// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/scene_bootstrap.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "telemime/core/random.h"
#include "telemime/image/light_change.h"

namespace telemime {
namespace {

cv::Mat empty_scene(Random& random) {
  cv::Mat image(120, 160, CV_8UC3, cv::Scalar(150, 150, 140));
  image(cv::Rect(0, 0, 160, 30)).setTo(cv::Scalar(90, 120, 60));
  for (int i = 0; i < 12; ++i) {
    image(cv::Rect(4 + 13 * i, 8 + (i * 7) % 60, 6, 9)).setTo(cv::Scalar(20 * i, 60, 200 - 12 * i));
  }
  for (std::size_t i = 0; i < image.total() * 3; ++i) {
    image.data[i] = cv::saturate_cast<unsigned char>(image.data[i] + random.normal(0, 1));
  }
  return image;
}

HeadRegion head_at(int x) {
  return {{x, 40}, {9, 13}};
}

cv::Mat with_person(cv::Mat image, int x) {
  cv::rectangle(image, cv::Rect(x - 24, 58, 48, 62), cv::Scalar(40, 30, 120), cv::FILLED);
  cv::rectangle(image, cv::Rect(x - 5, 50, 10, 12), cv::Scalar(120, 150, 200), cv::FILLED);
  cv::ellipse(image, {x, 40}, {9, 13}, 0, 0, 360, cv::Scalar(120, 150, 200), cv::FILLED);
  return image;
}

// The scene, empty for a number of frames, and with a person who is at x + step * i in the frame i of the
// others.
struct Part {
  int frames;
  int x = 0;
  int step = 0;
};
std::vector<cv::Mat> clip_of(const std::vector<Part>& parts) {
  Random random(1);
  std::vector<cv::Mat> clip;
  for (const Part& part : parts) {
    for (int i = 0; i < part.frames; ++i) {
      const cv::Mat empty = empty_scene(random);
      clip.push_back(part.x > 0 ? with_person(empty, part.x + part.step * i) : empty);
    }
  }
  return clip;
}

TEST(StillStretch, IsTheLongestEmptyPart) {
  // Without the frames next to the person.
  using Stretch = std::pair<std::size_t, std::size_t>;
  EXPECT_EQ(Stretch(find_still_stretch(clip_of({{20}, {20, 150, -4}}))), Stretch(0, 17));
  EXPECT_EQ(Stretch(find_still_stretch(clip_of({{15, 40, 5}, {15}}))), Stretch(18, 12));
  EXPECT_EQ(find_still_stretch(clip_of({{30, 20, 4}})).second, 0U) << "a moving clip";
}

// The clip with the places of the head.
std::vector<SceneSample> samples_of(const Part& part) {
  std::vector<SceneSample> samples;
  for (const cv::Mat& image : clip_of({part})) {
    const int x = part.x + part.step * static_cast<int>(samples.size());
    samples.push_back({.bgr = image, .head = head_at(x), .mask = {}});
  }
  return samples;
}

TEST(AroundPerson, MovingPersonUncoversBackground) {
  const BackgroundModel model = learn_around_person(samples_of({12, 30, 9}));
  Random random(4);
  const LogColour empty = log_colour(empty_scene(random));
  EXPECT_GT(cv::countNonZero(model.valid), 0.9 * model.valid.total());
  const cv::Mat wrong = (cv::abs(model.mean.l - empty.l) > 0.15) & model.valid;
  EXPECT_LT(cv::countNonZero(wrong), 0.02 * wrong.total());
}

TEST(AroundPerson, ExposureDoesNotMatter) {
  // The brightness rises and falls from sample to sample.
  std::vector<SceneSample> samples = samples_of({12, 30, 9});
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i].bgr.convertTo(samples[i].bgr, CV_8UC3, 1.0 + 0.3 * std::sin(1.3 * static_cast<double>(i)));
  }
  const BackgroundModel model = learn_around_person(samples);
  EXPECT_GT(cv::countNonZero(model.valid), 0.9 * model.valid.total());
  Random random(4);
  LogColour empty = log_colour(empty_scene(random));
  compensate(model, estimate_light(model, empty, {}), empty);
  const cv::Mat wrong = (cv::abs(model.mean.l - empty.l) > 0.15) & model.valid;
  EXPECT_LT(cv::countNonZero(wrong), 0.02 * wrong.total());
}

TEST(AroundPerson, AlwaysCoveredPixelsStayUnknown) {
  const std::vector<SceneSample> samples = samples_of({8, 80, 0});
  const BackgroundModel model = learn_around_person(samples);
  EXPECT_EQ(model.valid.at<unsigned char>(100, 80), 0);
  EXPECT_EQ(model.valid.at<unsigned char>(40, 80), 0);
  EXPECT_EQ(model.valid.at<unsigned char>(100, 10), 255);
  const ColourMixture surroundings = learn_surroundings(samples);
  ASSERT_FALSE(surroundings.empty());
  EXPECT_LT(mahalanobis2(surroundings, log_colour_of(150, 150, 140)), 9);
  EXPECT_GT(mahalanobis2(surroundings, log_colour_of(40, 30, 120)), 25);
}

// The person begins in front of the striped wall: their clothes have no part in its noise.
TEST(AroundPerson, NoiseIsThatOfTheBackground) {
  const BackgroundModel model = learn_around_person(samples_of({12, 30, 8}));
  for (int r = 0; r < model.valid.rows; ++r) {
    for (int c = 0; c < model.valid.cols; ++c) {
      const BackgroundNoise noise = background_noise(model.mean.l.at<float>(r, c));
      ASSERT_EQ(model.chroma_variance.at<float>(r, c), noise.chroma) << r << ' ' << c;
      ASSERT_EQ(model.luminance_variance.at<float>(r, c), noise.luminance) << r << ' ' << c;
    }
  }
}

}  // namespace
}  // namespace telemime
