// SPDX-License-Identifier: Apache-2.0
#include "telemime/image/person_finder.h"

#include <gtest/gtest.h>

#include <vector>

namespace telemime {
namespace {

constexpr double kFrame = 0.04;  // s
constexpr double kError = 0.15;  // m
const cv::Size kPicture(640, 480);

TEST(SamePerson, IsAsFarAwayAsPeopleMove) {
  const PersonPlace before{{300, 200}, 190};  // 200 pixels a metre
  EXPECT_TRUE(may_be_same(before, before, 0.0, kError));
  EXPECT_TRUE(may_be_same(before, {{340, 205}, 200}, kFrame, kError));
  // The neighbour, who sits 60 cm farther to the side, and somebody behind.
  EXPECT_FALSE(may_be_same(before, {{420, 200}, 190}, kFrame, kError));
  EXPECT_FALSE(may_be_same(before, {{310, 200}, 110}, kFrame, kError));
  // Both after they could have walked there.
  EXPECT_TRUE(may_be_same(before, {{420, 200}, 190}, 0.4, kError));
  EXPECT_TRUE(may_be_same(before, {{310, 200}, 110}, 0.4, kError));
}

TEST(SamePerson, IsTheSameInBothDirections) {
  const PersonPlace a{{300, 200}, 190};
  for (const PersonPlace& b : {PersonPlace{{352, 190}, 150}, {{330, 200}, 250}, {{250, 260}, 190}}) {
    EXPECT_EQ(may_be_same(a, b, kFrame, kError), may_be_same(b, a, kFrame, kError));
  }
}

TEST(OrderOfSearch, StartsWithLargeAndCentralPeople) {
  const std::vector<PersonPlace> places = {{{330, 200}, 90}, {{300, 200}, 200}, {{560, 200}, 210}};
  const auto order = order_of_search(places, std::nullopt, kPicture);
  EXPECT_EQ(order, (std::vector<std::size_t>{1, 2, 0}));
  EXPECT_TRUE(order_of_search({}, std::nullopt, kPicture).empty());
}

TEST(OrderOfSearch, StartsNearThePersonWhoIsFollowed) {
  const std::vector<PersonPlace> places = {{{320, 200}, 200}, {{120, 200}, 150}, {{110, 210}, 90}};
  EXPECT_EQ(order_of_search(places, PersonPlace{{115, 205}, 95}, kPicture).front(), 2U);
  EXPECT_EQ(order_of_search(places, PersonPlace{{130, 200}, 160}, kPicture).front(), 1U);
}

TEST(PersonFinder, WithoutNetworksFindsNobody) {
  PersonFinder finder;
  EXPECT_FALSE(finder.find(cv::Mat::zeros(480, 640, CV_8UC3), 0.0));
  EXPECT_EQ(finder.people(), 0);
}

}  // namespace
}  // namespace telemime
