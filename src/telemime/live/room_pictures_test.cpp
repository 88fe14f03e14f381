// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/room_pictures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace telemime {
namespace {

// How many pictures are taken when these are the times of the frames, in turn, without end.
std::size_t taken(const std::function<double(int)>& time) {
  int count = 0;
  return room_pictures([&] {
           Frame frame;
           frame.time = time(count++);
           return std::optional(frame);
         })
      .size();
}

TEST(RoomPictures, AreThoseOfOneSecond) {
  EXPECT_EQ(taken([](int i) { return i / 32.0; }), 33U);
  EXPECT_EQ(taken([](int i) { return 100.0 + i / 16.0; }), 17U) << "whatever the camera states";
}

TEST(RoomPictures, AreEightAtLeastAndSixtyAtMost) {
  EXPECT_EQ(taken([](int i) { return i / 5.0; }), 8U);
  EXPECT_EQ(taken([](int i) { return i / 120.0; }), 60U);
}

TEST(RoomPictures, OddTimesDoNoHarm) {
  EXPECT_EQ(taken([](int) { return 7.0; }), 60U) << "they stand still";
  EXPECT_EQ(taken([](int i) { return -i; }), 60U) << "they go back";
  EXPECT_EQ(taken([](int i) { return i < 3 ? i / 25.0 : 1e9; }), 8U) << "a gap";
  EXPECT_LE(taken([](int) { return std::numeric_limits<double>::quiet_NaN(); }), 60U);
}

TEST(RoomPictures, EndWithTheInput) {
  int left = 3;
  const auto next = [&] { return left-- > 0 ? std::optional(Frame{}) : std::nullopt; };
  EXPECT_EQ(room_pictures(next).size(), 3U);
  EXPECT_TRUE(room_pictures(next).empty());
}

}  // namespace
}  // namespace telemime
