// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/meeting_info.h"

#include <gtest/gtest.h>

namespace telemime::meeting {
namespace {

const MeetingInfo kBlue{"Blue \"room\"", 12, 3, {"p01", "p09"}, true};

TEST(MeetingInfo, IsReadAsWritten) {
  EXPECT_EQ(read_meeting_info(write_meeting_info(kBlue)), kBlue);
  EXPECT_EQ(read_meeting_info(write_meeting_info(MeetingInfo())), MeetingInfo());
  EXPECT_EQ(write_meeting_info({"Blue", 8, 2, {"p01"}, false}),
            R"({"chairs":["p01"],"epoch":2,"locked":false,"seats":8,"title":"Blue","v":1})");
}

TEST(MeetingInfo, MissingMembersHaveDefaults) {
  const auto meeting =
      read_meeting_info(R"({"v":1,"epoch":7,"seats":101,"chairs":["p01","A B",3],"locked":1})");
  ASSERT_TRUE(meeting);
  EXPECT_EQ(*meeting, (MeetingInfo{"", 8, 7, {"p01"}, false}));
}

TEST(MeetingInfo, InvalidMessagesAreRejected) {
  for (const char* const bad : {"", "{", "[]", R"({"v":2,"epoch":1})", R"({"v":1})", R"({"v":1,"epoch":-1})",
                                R"({"v":1,"epoch":4294967296})", R"({"v":1,"epoch":1.5})",
                                R"({"v":1,"epoch":1,"x":[[[[[[[[1]]]]]]]]})"}) {
    EXPECT_FALSE(read_meeting_info(bad)) << bad;
  }
  EXPECT_FALSE(read_meeting_info(R"({"v":1,"epoch":1,"x":")" + std::string(9000, 'x') + "\"}"));
}

TEST(MeetingInfo, ChangesEverythingButTheChairs) {
  const MeetingInfo own{"Blue", 8, 2, {"p01"}, false};
  EXPECT_FALSE(after_change(own, own));
  EXPECT_FALSE(after_change(own, std::nullopt)) << "rubbish, or cleared";
  MeetingInfo received{"Red", 4, 3, {"p09"}, true};
  const auto after = after_change(own, received);
  ASSERT_TRUE(after);
  EXPECT_EQ(*after, (MeetingInfo{"Red", 4, 3, {"p01"}, true}));
  received.epoch = 1;
  EXPECT_FALSE(after_change(own, received)) << "older";
}

}  // namespace
}  // namespace telemime::meeting
