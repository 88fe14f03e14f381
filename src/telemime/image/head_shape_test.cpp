// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/head_shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "telemime/image/person_shape.h"

namespace telemime {
namespace {

constexpr int kWhite = 255;

/// Head, neck, sloping shoulders and trunk.
cv::Mat person(const cv::Point& head, const cv::Size& radii) {
  cv::Mat image = cv::Mat::zeros(240, 320, CV_8UC1);
  cv::ellipse(image, head, radii, 0, 0, 360, kWhite, cv::FILLED);
  const int chin = head.y + radii.height;
  cv::rectangle(image, cv::Rect(head.x - radii.width / 2, chin - 4, radii.width, 16), kWhite, cv::FILLED);
  const std::vector<cv::Point> trunk{
      {head.x - radii.width / 2, chin + 8},  {head.x + radii.width / 2, chin + 8},
      {head.x + 3 * radii.width, chin + 24}, {head.x + 3 * radii.width, 239},
      {head.x - 3 * radii.width, 239},       {head.x - 3 * radii.width, chin + 24}};
  cv::fillPoly(image, std::vector<std::vector<cv::Point>>{trunk}, kWhite);
  return image;
}

TEST(HeadShape, SquareAndEllipseAreInverse) {
  const HeadShape shape{0.05, 0.4, 0.8, 0.6};
  const TrackedFace face{{100.25, 60.5}, 40.0, true, 1.0};
  const HeadRegion head = head_region(face, shape, 0.5, 0.5);
  const cv::Rect2d square = face_square(head, shape, 0.5, 0.5);
  EXPECT_NEAR(square.width, 40.0, 1e-9);
  EXPECT_NEAR(square.x + 0.5 * (square.width - 1), 100.25, 1e-9);
  EXPECT_NEAR(square.y + 0.5 * (square.height - 1), 60.5, 1e-9);
  EXPECT_TRUE(head.detected);
}

TEST(HeadShape, RebasedShapeIsTheSameHead) {
  const HeadShape shape{-0.05, 0.48, 0.72, 0.57};
  const TrackedFace outline{{100.0, 60.0}, 40.0, false, 1.0};
  const TrackedFace seen{{96.0, 63.0}, 33.0, true, 1.0};
  const HeadRegion before = head_region(outline, shape, 0.5, 0.5);
  const HeadRegion after = head_region(seen, rebased(shape, outline, seen), 0.5, 0.5);
  EXPECT_NEAR(after.centre.x(), before.centre.x(), 1e-9);
  EXPECT_NEAR(after.radii.x(), before.radii.x(), 1e-9);
  EXPECT_NEAR(after.centre.y() - after.radii.y(), before.centre.y() - before.radii.y(), 1e-9) << "the crown";
}

TEST(HeadShape, RebasedShapeStaysInRange) {
  const HeadShape shape;
  const TrackedFace outline{{100.0, 60.0}, 40.0, false, 1.0};
  const HeadShape small = rebased(shape, outline, {{200.0, 90.0}, 400.0, true, 1.0});
  const HeadShape large = rebased(shape, outline, {{0.0, 90.0}, 4.0, true, 1.0});
  for (const HeadShape& s : {small, large}) {
    EXPECT_LE(std::abs(s.shift), 0.25);
    EXPECT_GE(s.half_width, 0.34);
    EXPECT_LE(s.half_width, 0.62);
    EXPECT_GE(s.crown, 0.5);
    EXPECT_LE(s.crown, 1.0);
    EXPECT_EQ(s.chin, shape.chin);
  }
}

TEST(HeadShape, OutlineGivesTheHead) {
  for (const cv::Point where : {cv::Point(160, 70), cv::Point(90, 100), cv::Point(200, 50)}) {
    const auto head = head_from_silhouette(person(where, {18, 26}));
    ASSERT_TRUE(head.has_value());
    EXPECT_NEAR(head->centre.x(), where.x, 2);
    EXPECT_NEAR(head->centre.y(), where.y, 5);
    EXPECT_NEAR(head->radii.x(), 18, 2);
    EXPECT_NEAR(head->radii.y(), 26, 5);
    EXPECT_FALSE(head->detected);
  }
}

TEST(HeadShape, NoHeadInBoxOrEmptyMask) {
  cv::Mat box = cv::Mat::zeros(240, 320, CV_8UC1);
  EXPECT_FALSE(head_from_silhouette(box).has_value());
  box(cv::Rect(100, 60, 80, 180)).setTo(kWhite);
  EXPECT_FALSE(head_from_silhouette(box).has_value());
}

TEST(HeadShape, AdaptsToHairAndStopsThere) {
  const cv::Mat silhouette = person({160, 80}, {26, 36});
  TrackedFace face{{160, 80}, 50.0, true, 1.0};
  HeadShape shape;
  for (int i = 0; i < 40; ++i) {
    shape = adapted(shape, head_region(face, shape, 1, 1), silhouette, 0.3);
  }
  EXPECT_NEAR(shape.half_width * 50, 26, 2.5);
  EXPECT_NEAR(shape.crown * 50, 36, 2);
  EXPECT_NEAR(shape.shift, 0, 0.02);
  EXPECT_EQ(shape.chin, HeadShape{}.chin);
}

TEST(HeadShape, FacingTheCameraMeansTwoShoulders) {
  const cv::Mat silhouette = person({160, 70}, {18, 26});
  HeadRegion head{{160, 70}, {18, 26}};
  EXPECT_TRUE(faces_camera(head, silhouette));
  head.centre.x() = 200;
  EXPECT_FALSE(faces_camera(head, silhouette));
}

TEST(PersonShape, CutFindsPersonAndIsDeterministic) {
  cv::Mat bgr(240, 320, CV_8UC3, cv::Scalar(150, 140, 130));
  const cv::Mat truth = person({160, 70}, {18, 26});
  bgr.setTo(cv::Scalar(40, 40, 160), truth);
  cv::ellipse(bgr, {160, 70}, {18, 26}, 0, 0, 360, cv::Scalar(130, 160, 210), cv::FILLED);
  HeadRegion head{{160, 70}, {18, 26}};
  const cv::Mat first = cut_person(bgr, head);
  const double both = cv::countNonZero(first & truth);
  EXPECT_GT(both / cv::countNonZero(first | truth), 0.9);
  cv::theRNG().state = 12345;
  EXPECT_EQ(cv::countNonZero(first != cut_person(bgr, head)), 0);
  EXPECT_EQ(cv::theRNG().state, 12345U);
}

TEST(PersonShape, PriorIsHighOnHeadAndLowFarAway) {
  HeadRegion head{{160, 70}, {18, 26}};
  const cv::Mat prior = body_prior({320, 240}, head);
  EXPECT_GT(prior.at<float>(70, 160), 0.9F);
  EXPECT_GT(prior.at<float>(200, 160), 0.9F);
  EXPECT_LT(prior.at<float>(100, 319), 0.0F);
}

}  // namespace
}  // namespace telemime
