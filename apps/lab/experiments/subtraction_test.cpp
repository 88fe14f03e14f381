// SPDX-License-Identifier: Apache-2.0
#include "lab/experiments/subtraction.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/core/random.h"

namespace telemime {
namespace {

cv::Mat scene(Random& random, double light) {
  cv::Mat out(120, 160, CV_8UC3);
  for (int r = 0; r < out.rows; ++r) {
    for (int c = 0; c < out.cols; ++c) {
      // Stripes, so that there are gradients to compare.
      const double base = (c / 20) % 2 == 0 ? 150 : 90;
      for (int k = 0; k < 3; ++k) {
        out.at<cv::Vec3b>(r, c)[k] =
            cv::saturate_cast<unsigned char>(light * (base + 5 * k) + random.normal(0, 1.5));
      }
    }
  }
  return out;
}

std::vector<cv::Mat> empty_scenes(Random& random) {
  std::vector<cv::Mat> pictures;
  pictures.reserve(64);
  for (int i = 0; i < 20; ++i) {
    pictures.push_back(scene(random, 1.0));
  }
  return pictures;
}

const cv::Rect kPerson(60, 40, 40, 80);

cv::Mat with_person(cv::Mat picture) {
  picture(kPerson).setTo(cv::Scalar(60, 70, 190));
  return picture;
}

/// Intersection over union of the mask with the person's rectangle.
double overlap(const cv::Mat& mask) {
  cv::Mat truth = cv::Mat::zeros(mask.size(), CV_8UC1);
  truth(kPerson).setTo(255);
  return cv::countNonZero(mask & truth) / static_cast<double>(cv::countNonZero(mask | truth));
}

class EverySubtraction : public ::testing::TestWithParam<Subtraction> {};

TEST_P(EverySubtraction, FindsThePersonInSteadyLight) {
  Random random(1);
  const auto pictures = empty_scenes(random);
  const auto subtractor = make_subtractor(GetParam(), pictures);
  EXPECT_LT(cv::countNonZero(subtractor(scene(random, 1.0))), 100);
  EXPECT_GT(overlap(subtractor(with_person(scene(random, 1.0)))), 0.9);
}

TEST_P(EverySubtraction, NeedsPictures) {
  EXPECT_THROW(make_subtractor(GetParam(), {}), Error);
}

INSTANTIATE_TEST_SUITE_P(All, EverySubtraction,
                         ::testing::Values(Subtraction::rgb_difference, Subtraction::mixture,
                                           Subtraction::reference, Subtraction::robust));

TEST(Subtraction, OnlyChromaMethodsSurviveAChangeOfLight) {
  Random random(2);
  const auto pictures = empty_scenes(random);
  const cv::Mat bright = with_person(scene(random, 1.3));
  EXPECT_GT(overlap(make_subtractor(Subtraction::robust, pictures)(bright)), 0.9);
  EXPECT_GT(overlap(make_subtractor(Subtraction::reference, pictures)(bright)), 0.8);
  // Figure 3-6 of the thesis: the plain difference takes the whole background.
  EXPECT_LT(overlap(make_subtractor(Subtraction::rgb_difference, pictures)(bright)), 0.5);
}

TEST(ReferenceBackground, OnlyAnotherColourIsForeground) {
  const std::vector<cv::Mat> same(5, cv::Mat(20, 20, CV_8UC3, cv::Scalar(90, 100, 110)));
  const ReferenceBackground model = learn_reference_background(same);
  const cv::Mat other(20, 20, CV_8UC3, cv::Scalar(250, 0, 0));
  EXPECT_EQ(cv::countNonZero(reference_foreground(model, same.front(), 0.999)), 0) << "the mean itself";
  EXPECT_EQ(cv::countNonZero(reference_foreground(model, other, 1e-6)), 20 * 20);
  EXPECT_THROW(reference_foreground(model, other, 1.0), Error);
}

}  // namespace
}  // namespace telemime
