// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/segmentation.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace telemime {
namespace {

const cv::Mat kEverywhere(120, 160, CV_8UC1, cv::Scalar(255));
const cv::Scalar kWall(150, 150, 145);
const cv::Scalar kSkinColour(125, 155, 205);
const cv::Scalar kShirt(150, 60, 40);
const cv::Scalar kTrousers(40, 36, 33);

/// A person with one forearm beside and one in front of the trunk, and trousers below.
cv::Mat test_image() {
  cv::Mat image(120, 160, CV_8UC3, kWall);
  cv::rectangle(image, cv::Rect(58, 50, 44, 50), kShirt, cv::FILLED);
  cv::rectangle(image, cv::Rect(50, 100, 60, 20), kTrousers, cv::FILLED);
  cv::rectangle(image, cv::Rect(75, 42, 10, 12), kSkinColour, cv::FILLED);
  cv::ellipse(image, {80, 30}, {10, 14}, 0, 0, 360, kSkinColour, cv::FILLED);
  cv::rectangle(image, cv::Rect(40, 60, 18, 8), kSkinColour, cv::FILLED);
  cv::rectangle(image, cv::Rect(66, 76, 30, 8), kSkinColour, cv::FILLED);
  return image;
}

// How this image differs from the wall alone.
BackgroundEnergy against_the_wall(const LogColour& colour) {
  const std::vector<cv::Mat> empty(5, cv::Mat(colour.l.size(), CV_8UC3, kWall));
  return background_energy(learn_background_model(empty), colour, ShadowRange{});
}

struct Scene {
  LogColour colour;
  BackgroundEnergy background;
  HeadRegion head;
  PersonColours colours;
};

Scene scene() {
  Scene s;
  s.colour = log_colour(test_image());
  s.background = against_the_wall(s.colour);
  s.head = {{80, 30}, {10.5, 14.5}, true};
  const Segmentation rough = segment(s.colour, s.background, {}, s.head, {});
  const PersonReport report = learn_person_colours(s.colour, rough.silhouette, s.head, s.colours);
  EXPECT_TRUE(report.accepted) << report.reason;
  return s;
}

Label at(const cv::Mat& labels, int x, int y) {
  return static_cast<Label>(labels.at<unsigned char>(y, x));
}

TEST(Segmentation, EachPartGetsItsLabel) {
  const Scene s = scene();
  const Segmentation out = segment(s.colour, s.background, s.colours, s.head, {});
  EXPECT_EQ(at(out.labels, 80, 30), Label::head);
  EXPECT_EQ(at(out.labels, 80, 46), Label::head) << "the neck";
  EXPECT_EQ(at(out.labels, 80, 60), Label::clothes);
  EXPECT_EQ(at(out.labels, 48, 64), Label::arms) << "beside the trunk";
  EXPECT_EQ(at(out.labels, 80, 80), Label::arms) << "in front of the trunk";
  EXPECT_EQ(at(out.labels, 60, 112), Label::ignore) << "trousers";
  EXPECT_EQ(at(out.labels, 10, 10), Label::background);
  EXPECT_EQ(at(out.labels, 130, 90), Label::background);
}

// A person visible from head to foot, in an image of twice the size, with a hanging arm of the given length.
Segmentation seen_whole(int arm, double head_height, const SegmentationConfig& config = {}) {
  cv::Mat image(240, 320, CV_8UC3, kWall);
  cv::rectangle(image, cv::Rect(142, 46, 36, 60), kShirt, cv::FILLED);
  cv::rectangle(image, cv::Rect(146, 106, 28, 80), kTrousers, cv::FILLED);
  cv::rectangle(image, cv::Rect(148, 186, 24, 14), kSkinColour, cv::FILLED);
  cv::rectangle(image, cv::Rect(155, 38, 10, 10), kSkinColour, cv::FILLED);
  cv::ellipse(image, {160, 28}, {9, 13}, 0, 0, 360, kSkinColour, cv::FILLED);
  cv::rectangle(image, cv::Rect(130, 64, 12, arm), kSkinColour, cv::FILLED);
  const LogColour colour = log_colour(image);
  const BackgroundEnergy background = against_the_wall(colour);
  HeadRegion head{{160, 28}, {9.5, 13.5}, true};
  PersonColours colours;
  EXPECT_TRUE(
      learn_person_colours(colour, segment(colour, background, {}, head, {}).silhouette, head, colours)
          .accepted);
  head.radii.y() = head_height;
  return segment(colour, background, colours, head, config);
}

TEST(Segmentation, BareAnklesAreNotArms) {
  const Segmentation out = seen_whole(48, 13.5);
  EXPECT_EQ(at(out.labels, 136, 106), Label::arms) << "a hanging hand";
  EXPECT_EQ(at(out.labels, 160, 194), Label::ignore);
  EXPECT_EQ(out.silhouette.at<unsigned char>(194, 160), 255) << "they belong to the person";
}

TEST(Segmentation, FingersAreFoundWithBowedHead) {
  // One metre from the centre of the head, with a head that seems 10 % too low.
  const Segmentation out = seen_whole(76, 12.15);
  EXPECT_EQ(at(out.labels, 136, 138), Label::arms);
  EXPECT_EQ(at(out.labels, 160, 194), Label::ignore) << "ankles";
}

TEST(Segmentation, WideLensAllowsHandsFartherAway) {
  SegmentationConfig wide;
  wide.focal_length = 0.5F;  // 90 degrees: a person of the same size in the image is nearer
  EXPECT_EQ(at(seen_whole(76, 12.15, wide).labels, 160, 194), Label::arms);
}

TEST(Segmentation, BackgroundIsOutsideTheSilhouette) {
  const Scene s = scene();
  const Segmentation out = segment(s.colour, s.background, s.colours, s.head, {});
  EXPECT_EQ(cv::countNonZero((out.labels == 0) != (out.silhouette == 0)), 0);
}

TEST(Segmentation, WithoutColoursOnlyHeadIsLabelled) {
  const Scene s = scene();
  const Segmentation out = segment(s.colour, s.background, {}, s.head, {});
  EXPECT_EQ(cv::countNonZero(out.labels == static_cast<unsigned char>(Label::arms)), 0);
  EXPECT_EQ(cv::countNonZero(out.labels == static_cast<unsigned char>(Label::clothes)), 0);
  EXPECT_EQ(at(out.labels, 80, 70), Label::ignore);
}

TEST(Segmentation, ForeignBoxIsRemoved) {
  Scene s = scene();
  cv::Mat image = test_image();
  cv::rectangle(image, cv::Rect(125, 20, 25, 25), cv::Scalar(30, 160, 60), cv::FILLED);
  s.colour = log_colour(image);
  s.background = against_the_wall(s.colour);
  const Segmentation out = segment(s.colour, s.background, s.colours, s.head, {});
  EXPECT_EQ(at(out.labels, 137, 32), Label::background);
  EXPECT_EQ(at(out.labels, 48, 64), Label::arms);
}

TEST(PersonColours, RefusesTinyFaceAndHiddenChest) {
  const Scene s = scene();
  PersonColours colours;
  HeadRegion tiny = s.head;
  tiny.radii = {1, 1.5};
  PersonReport report = learn_person_colours(s.colour, kEverywhere, tiny, colours);
  EXPECT_FALSE(report.accepted);
  EXPECT_NE(report.reason.find("pixels"), std::string::npos);
  const LogColour all_skin = log_colour(cv::Mat(120, 160, CV_8UC3, kSkinColour));
  report = learn_person_colours(all_skin, kEverywhere, s.head, colours);
  EXPECT_FALSE(report.accepted);
  EXPECT_FALSE(report.reason.empty());
  EXPECT_FALSE(colours.known());
}

TEST(PersonColours, MaskOnHalfTheFaceIsNotSkin) {
  cv::Mat image = test_image();
  cv::rectangle(image, cv::Rect(70, 33, 20, 9), cv::Scalar(225, 222, 220), cv::FILLED);
  PersonColours colours;
  const Scene s = scene();
  ASSERT_TRUE(learn_person_colours(log_colour(image), kEverywhere, s.head, colours).accepted);
  EXPECT_LT(mahalanobis2(colours.skin, log_colour_of(125, 155, 205)), 4);
  EXPECT_GT(mahalanobis2(colours.skin, log_colour_of(225, 222, 220)), 9);
}

TEST(PersonColours, ObjectOfMaskColourIsNotAnArm) {
  const cv::Scalar white(225, 222, 220);
  cv::Mat image = test_image();
  const cv::Rect shoe(102, 84, 10, 8);
  cv::rectangle(image, shoe, white, cv::FILLED);
  const auto label_of_the_shoe = [&](bool masked) {
    Scene s = scene();
    cv::Mat shown = image.clone();
    if (masked) {
      cv::rectangle(shown, cv::Rect(70, 33, 20, 9), white, cv::FILLED);
    }
    const LogColour colour = log_colour(shown);
    EXPECT_TRUE(learn_person_colours(colour, kEverywhere, s.head, s.colours).accepted);
    const Segmentation out = segment(colour, against_the_wall(colour), s.colours, s.head, {});
    EXPECT_EQ(at(out.labels, 48, 64), Label::arms) << "a true arm";
    EXPECT_EQ(at(out.labels, 80, 60), Label::clothes);
    return at(out.labels, shoe.x + 5, shoe.y + 4);
  };
  EXPECT_EQ(label_of_the_shoe(true), Label::ignore);
  EXPECT_NE(label_of_the_shoe(false), Label::ignore) << "unknown scraps get the label of their neighbours";
}

TEST(PersonColours, ShirtInsideHeadEllipseIsNoMask) {
  // If the head is found too low, it contains part of the shirt, which must remain clothes.
  cv::Mat image = test_image();
  cv::rectangle(image, cv::Rect(70, 38, 20, 12), kShirt, cv::FILLED);
  PersonColours colours;
  const Scene s = scene();
  ASSERT_TRUE(learn_person_colours(log_colour(image), kEverywhere, s.head, colours).accepted);
  EXPECT_GT(mahalanobis2(colours.other, log_colour_of(150, 60, 40)), 9);
}

}  // namespace
}  // namespace telemime
