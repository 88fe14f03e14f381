// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/face_memory.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace telemime {
namespace {

struct Scene {
  cv::Mat bgr{240, 320, CV_8UC3, cv::Scalar(150, 150, 150)};
  cv::Mat labels = cv::Mat::zeros(240, 320, CV_8UC1);
  cv::Mat skin{240, 320, CV_8UC1, cv::Scalar(255)};
  HeadRegion head;
};

/// A face with dark eyes and mouth.
Scene face() {
  Scene s;
  s.head.centre = {160, 80};
  s.head.radii = {22, 30};
  cv::ellipse(s.bgr, {160, 80}, {22, 30}, 0, 0, 360, cv::Scalar(110, 140, 190), cv::FILLED);
  cv::ellipse(s.labels, {160, 80}, {22, 30}, 0, 0, 360, static_cast<int>(Label::head), cv::FILLED);
  for (const cv::Point p : {cv::Point(151, 74), cv::Point(169, 74), cv::Point(160, 96)}) {
    cv::ellipse(s.bgr, p, {5, 3}, 0, 0, 360, cv::Scalar(30, 30, 60), cv::FILLED);
  }
  return s;
}

/// The same face with a brighter arm from below up to the mouth, which is already labelled arms outside the
/// head.
Scene hand_before_face() {
  Scene s = face();
  const cv::Rect arm(148, 86, 24, 100);
  cv::Mat below = s.labels == 0;
  cv::Mat mask = cv::Mat::zeros(s.labels.size(), CV_8UC1);
  mask(arm).setTo(255);
  s.labels.setTo(static_cast<int>(Label::arms), mask & below);
  s.bgr(arm).setTo(cv::Scalar(150, 185, 245));
  return s;
}

TEST(FaceMemory, HandBeforeMouthBecomesArms) {
  FaceMemory memory;
  for (int i = 0; i < 5; ++i) {
    Scene s = face();
    label_hands_over_face(memory, log_colour(s.bgr), s.head, s.skin, s.labels);
    EXPECT_EQ(cv::countNonZero(s.labels == static_cast<int>(Label::arms)), 0);
  }
  Scene s = hand_before_face();
  label_hands_over_face(memory, log_colour(s.bgr), s.head, s.skin, s.labels);
  EXPECT_EQ(s.labels.at<unsigned char>(98, 160), static_cast<int>(Label::arms));
  EXPECT_EQ(s.labels.at<unsigned char>(65, 160), static_cast<int>(Label::head)) << "the brow keeps its label";
  EXPECT_EQ(s.labels.at<unsigned char>(150, 160), static_cast<int>(Label::arms));
}

TEST(FaceMemory, WithoutMemoryNothingChanges) {
  FaceMemory memory;
  Scene s = hand_before_face();
  label_hands_over_face(memory, log_colour(s.bgr), s.head, s.skin, s.labels);
  EXPECT_EQ(s.labels.at<unsigned char>(98, 160), static_cast<int>(Label::head));
}

TEST(FaceMemory, OnlySkinCanBeAHand) {
  FaceMemory memory;
  for (int i = 0; i < 5; ++i) {
    Scene s = face();
    label_hands_over_face(memory, log_colour(s.bgr), s.head, s.skin, s.labels);
  }
  Scene s = hand_before_face();
  s.skin.setTo(0);
  label_hands_over_face(memory, log_colour(s.bgr), s.head, s.skin, s.labels);
  EXPECT_EQ(s.labels.at<unsigned char>(98, 160), static_cast<int>(Label::head));
}

}  // namespace
}  // namespace telemime
