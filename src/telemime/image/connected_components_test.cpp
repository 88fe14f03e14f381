// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/connected_components.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <tuple>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/core/random.h"

namespace telemime {
namespace {

using Found = std::tuple<int, int, int, int, int>;

std::vector<Found> sorted(std::vector<Found> found) {
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<Found> by_opencv(const cv::Mat& mask, int connectivity, cv::Mat& labels) {
  cv::Mat stats;
  cv::Mat centroids;
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centroids, connectivity, CV_32S);
  std::vector<Found> found;
  for (int i = 1; i < count; ++i) {
    found.emplace_back(stats.at<int>(i, cv::CC_STAT_AREA), stats.at<int>(i, cv::CC_STAT_LEFT),
                       stats.at<int>(i, cv::CC_STAT_TOP), stats.at<int>(i, cv::CC_STAT_WIDTH),
                       stats.at<int>(i, cv::CC_STAT_HEIGHT));
  }
  return sorted(found);
}

std::vector<Found> pixels_of(const ConnectedComponents& components) {
  std::vector<Found> found;
  for (const Component& c : components.all()) {
    found.emplace_back(c.area, c.box.x, c.box.y, c.box.width, c.box.height);
  }
  return sorted(found);
}

// Noise of many densities, fine and coarse, at odd sizes.
std::vector<cv::Mat> masks() {
  Random random(3, 0);
  std::vector<cv::Mat> made;
  for (int i = 0; i < 60; ++i) {
    cv::Mat mask(1 + static_cast<int>(random.uniform() * 60), 1 + static_cast<int>(random.uniform() * 90),
                 CV_8UC1);
    const double density = random.uniform();
    mask.forEach<unsigned char>([](unsigned char& pixel, const int*) { pixel = 0; });
    for (int r = 0; r < mask.rows; ++r) {
      for (int c = 0; c < mask.cols; ++c) {
        mask.at<unsigned char>(r, c) =
            random.uniform() < density ? 1 + static_cast<int>(random.uniform() * 254) : 0;
      }
    }
    if (i % 2 == 0) {
      cv::medianBlur(mask, mask, 3);
    }
    made.push_back(mask);
  }
  return made;
}

TEST(ConnectedComponents, EqualThoseOfOpenCv) {
  for (const cv::Mat& mask : masks()) {
    for (const auto& [connectivity, number] :
         {std::pair{Connectivity::four, 4}, std::pair{Connectivity::eight, 8}}) {
      cv::Mat labels;
      const std::vector<Found> expected = by_opencv(mask, number, labels);
      const ConnectedComponents components(mask, connectivity);
      ASSERT_EQ(pixels_of(components), expected) << mask.size() << ", " << number << " neighbours";
      // Each component is the complete set of pixels of one label.
      cv::Mat rest = mask.clone();
      for (const Component& component : components.all()) {
        const PixelRun first = components.runs(component).front();
        const int label = labels.at<int>(first.row, first.first);
        ASSERT_EQ(components.count(component, [&](int r, int c) { return labels.at<int>(r, c) == label; }),
                  component.area);
        components.paint(component, 0, rest);
      }
      ASSERT_EQ(cv::countNonZero(rest), 0);
    }
  }
}

TEST(ConnectedComponents, AreSortedByFirstPixelAndRow) {
  // A U, whose two arms are connected only at the bottom, and a point between them.
  cv::Mat mask = cv::Mat::zeros(4, 7, CV_8UC1);
  mask.col(1).setTo(255);
  mask.col(5).setTo(255);
  mask.row(3).colRange(1, 6).setTo(255);
  mask.at<unsigned char>(1, 3) = 255;
  const ConnectedComponents components(mask, Connectivity::eight);
  ASSERT_EQ(components.all().size(), 2U);
  EXPECT_EQ(components.all()[0].area, 11);
  EXPECT_EQ(components.all()[1].box, cv::Rect(3, 1, 1, 1));
  const auto runs = components.runs(components.all()[0]);
  EXPECT_TRUE(std::is_sorted(runs.begin(), runs.end(), [](const PixelRun& a, const PixelRun& b) {
    return std::pair(a.row, a.first) < std::pair(b.row, b.first);
  }));
}

TEST(ConnectedComponents, ArePaintedRelativeToTheOrigin) {
  cv::Mat mask = cv::Mat::zeros(5, 8, CV_8UC1);
  mask(cv::Rect(3, 2, 4, 2)).setTo(255);
  const ConnectedComponents components(mask, Connectivity::four);
  cv::Mat part = cv::Mat::zeros(4, 6, CV_8UC1);
  components.paint(components.all()[0], 7, part, cv::Point(2, 1));
  EXPECT_EQ(cv::boundingRect(part), cv::Rect(1, 1, 4, 2));
  EXPECT_EQ(cv::countNonZero(part == 7), 8);
}

TEST(ConnectedComponents, EmptyMaskHasNone) {
  EXPECT_TRUE(ConnectedComponents(cv::Mat::zeros(3, 9, CV_8UC1), Connectivity::four).all().empty());
  EXPECT_THROW(ConnectedComponents(cv::Mat::zeros(3, 9, CV_32SC1), Connectivity::four), Error);
}

}  // namespace
}  // namespace telemime
