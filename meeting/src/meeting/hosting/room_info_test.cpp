// SPDX-License-Identifier: Apache-2.0
#include "meeting/hosting/room_info.h"

#include <gtest/gtest.h>

namespace telemime {
namespace {

const RoomInfo kBlue{"Blue \"room\"", 12, 3, {"p01", "p09"}, true};

TEST(RoomInfo, IsReadAsItWasWritten) {
  EXPECT_EQ(read_room_info(write_room_info(kBlue)), kBlue);
  EXPECT_EQ(read_room_info(write_room_info(RoomInfo())), RoomInfo());
  EXPECT_EQ(write_room_info({"Blue", 8, 2, {"p01"}, false}),
            R"({"chairs":["p01"],"epoch":2,"locked":false,"seats":8,"title":"Blue","v":1})");
}

TEST(RoomInfo, WhatIsLeftOutHasItsUsualValue) {
  const auto room = read_room_info(R"({"v":1,"epoch":7,"seats":101,"chairs":["p01","A B",3],"locked":1})");
  ASSERT_TRUE(room);
  EXPECT_EQ(*room, (RoomInfo{"", 8, 7, {"p01"}, false}));
}

TEST(RoomInfo, WhatIsNoneIsRefused) {
  for (const char* const bad : {"", "{", "[]", R"({"v":2,"epoch":1})", R"({"v":1})", R"({"v":1,"epoch":-1})",
                                R"({"v":1,"epoch":4294967296})", R"({"v":1,"epoch":1.5})",
                                R"({"v":1,"epoch":1,"x":[[[[[[[[1]]]]]]]]})"}) {
    EXPECT_FALSE(read_room_info(bad)) << bad;
  }
  EXPECT_FALSE(read_room_info(R"({"v":1,"epoch":1,"x":")" + std::string(9000, 'x') + "\"}"));
}

TEST(RoomInfo, AChairChangesAllButTheChairs) {
  const RoomInfo own{"Blue", 8, 2, {"p01"}, false};
  EXPECT_FALSE(after_hearing(own, own));
  EXPECT_FALSE(after_hearing(own, std::nullopt)) << "rubbish, or cleared";
  RoomInfo told{"Red", 4, 3, {"p09"}, true};
  const auto after = after_hearing(own, told);
  ASSERT_TRUE(after);
  EXPECT_EQ(*after, (RoomInfo{"Red", 4, 3, {"p01"}, true}));
  told.epoch = 1;
  EXPECT_FALSE(after_hearing(own, told)) << "older";
}

}  // namespace
}  // namespace telemime
