// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/put_away.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace telemime {
namespace {

OfflineFrame frame_of(int width, int height) {
  OfflineFrame frame;
  frame.frame.image = cv::Mat(height, width, CV_8UC3, cv::Scalar(200, 180, 160));
  cv::circle(frame.frame.image, {width / 2, height / 2}, height / 3, {40, 60, 120}, cv::FILLED, cv::LINE_AA);
  frame.frame.index = 7;
  return frame;
}

TEST(PutAway, ImageComesBackNearlyAsItWasAndWaitsSmall) {
  OfflineFrame frame = frame_of(641, 479);
  const cv::Mat before = frame.frame.image.clone();
  put_away(frame);
  EXPECT_TRUE(frame.frame.image.empty());
  EXPECT_LT(frame.packed.capacity() * 10, before.total() * before.elemSize());
  take_out(frame);
  EXPECT_TRUE(frame.packed.empty());
  ASSERT_EQ(frame.frame.image.size(), before.size());
  ASSERT_EQ(frame.frame.image.type(), before.type());
  EXPECT_LT(cv::norm(frame.frame.image, before, cv::NORM_L1) / static_cast<double>(3 * before.total()), 1.0);
  EXPECT_EQ(frame.frame.index, 7);
}

TEST(PutAway, OthersKeepTheirImage) {
  OfflineFrame frame = frame_of(64, 48);
  const cv::Mat image = frame.frame.image;
  put_away(frame);
  EXPECT_FALSE(image.empty()) << "others hold it, too";
  OfflineFrame copy = frame;
  take_out(copy);
  EXPECT_TRUE(frame.frame.image.empty());
  EXPECT_FALSE(copy.frame.image.empty());
}

TEST(PutAway, WhatHasNoImageStaysSo) {
  OfflineFrame frame;
  put_away(frame);
  take_out(frame);
  EXPECT_TRUE(frame.frame.image.empty());
}

TEST(PutAway, WhatCannotBeCompressedStays) {
  OfflineFrame frame;
  frame.frame.image = cv::Mat(1, 65501, CV_8UC3, cv::Scalar::all(9));
  put_away(frame);
  EXPECT_EQ(frame.frame.image.cols, 65501);
  take_out(frame);
  EXPECT_EQ(frame.frame.image.cols, 65501);
}

}  // namespace
}  // namespace telemime
