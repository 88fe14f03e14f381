// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "telemime/core/errors.h"
#include "telemime/core/random.h"

namespace telemime {
namespace {

const cv::Mat kEverywhere(60, 80, CV_8UC1, cv::Scalar(255));

cv::Mat step_at(int column, int height) {
  cv::Mat image(60, 80, CV_8UC1, cv::Scalar(50));
  image.colRange(column, 80).setTo(50 + height);
  return image;
}

TEST(Edges, StepGivesOneThinLine) {
  const cv::Mat edges = find_edges(deriche_gradient(step_at(40, 100), 1.2), kEverywhere, 3, 8);
  for (int r = 5; r < 55; ++r) {
    EXPECT_EQ(cv::countNonZero(edges.row(r)), 1);
    EXPECT_TRUE(edges.at<unsigned char>(r, 39) != 0 || edges.at<unsigned char>(r, 40) != 0);
  }
}

TEST(Edges, WeakEdgesNeedStrongNeighbours) {
  EXPECT_EQ(cv::countNonZero(find_edges(deriche_gradient(step_at(40, 12), 1.2), kEverywhere, 1, 20)), 0);
  // A step that fades from 130 grey levels at the top to 12 at the bottom.
  cv::Mat image(60, 80, CV_8UC1, cv::Scalar(50));
  for (int r = 0; r < 60; ++r) {
    image.row(r).colRange(40, 80).setTo(180 - 2 * r);
  }
  const cv::Mat edges = find_edges(deriche_gradient(image, 1.2), kEverywhere, 1, 20);
  EXPECT_GE(cv::countNonZero(edges.rowRange(45, 58)), 13);
}

TEST(Edges, NoneOutsideTheMask) {
  cv::Mat mask = cv::Mat::zeros(60, 80, CV_8UC1);
  mask.rowRange(0, 30).setTo(255);
  const cv::Mat edges = find_edges(deriche_gradient(step_at(40, 100), 1.2), mask, 3, 8);
  EXPECT_GT(cv::countNonZero(edges), 20);
  EXPECT_EQ(cv::countNonZero(edges.rowRange(30, 60)), 0);
}

TEST(Edges, RefusesBadThresholdsAndSizes) {
  const Gradient g = deriche_gradient(step_at(40, 100), 1.2);
  EXPECT_THROW(find_edges(g, kEverywhere, 9, 8), Error);
  EXPECT_THROW(find_edges(g, cv::Mat(3, 3, CV_8UC1), 3, 8), Error);
}

TEST(DistanceMap, IsWithinTheChamferError) {
  cv::Mat edges = cv::Mat::zeros(61, 81, CV_8UC1);
  edges.at<unsigned char>(30, 40) = 255;
  const cv::Mat distance = distance_map(edges, 1000);
  for (const cv::Point p : {cv::Point(40, 30), cv::Point(50, 30), cv::Point(40, 0), cv::Point(60, 45)}) {
    const double exact = std::hypot(p.x - 40, p.y - 30);
    EXPECT_NEAR(distance.at<float>(p), exact, 0.025 * exact + 1e-6);
  }
}

TEST(DistanceMap, IsCappedAndCapWithoutEdges) {
  cv::Mat edges = cv::Mat::zeros(20, 30, CV_8UC1);
  EXPECT_EQ(cv::norm(distance_map(edges, 10) - 10, cv::NORM_INF), 0);
  edges.at<unsigned char>(0, 0) = 255;
  double largest = 0;
  cv::minMaxLoc(distance_map(edges, 10), nullptr, &largest);
  EXPECT_EQ(largest, 10);
}

TEST(DistanceMap, EqualsOpenCvToTheLastBit) {
  cv::ipp::setUseIPP(false);  // IPP has its own chamfer distance
  Random random(5, 0);
  for (const cv::Size size :
       {cv::Size(90, 70), cv::Size(1, 1), cv::Size(3, 40), cv::Size(41, 2), cv::Size(160, 120)}) {
    for (const double cap : {0.5, 12.3, 40.0, 1000.0}) {
      for (const double density : {0.001, 0.02, 0.3}) {
        cv::Mat edges = cv::Mat::zeros(size, CV_8UC1);
        std::for_each(edges.begin<unsigned char>(), edges.end<unsigned char>(),
                      [&](unsigned char& pixel) { pixel = random.uniform() < density ? 255 : 0; });
        edges.at<unsigned char>(size.height / 2, size.width / 2) = 255;
        cv::Mat expected;
        cv::distanceTransform(edges == 0, expected, cv::DIST_L2, cv::DIST_MASK_5, CV_32F);
        cv::min(expected, cap, expected);
        ASSERT_EQ(cv::norm(distance_map(edges, cap), expected, cv::NORM_INF), 0) << size << ' ' << cap;
      }
    }
  }
}

}  // namespace
}  // namespace telemime
