// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/room_topic.h"

#include <gtest/gtest.h>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

const RoomAddress kRoom{"home", "studio"};

TEST(RoomTopic, HasItsText) {
  EXPECT_EQ(topic_text(kRoom, {RoomTopicKind::pose, "p01", 0}), "r/home/studio/p/p01/pose");
  EXPECT_EQ(topic_text(kRoom, {RoomTopicKind::state, "p01", 0}), "r/home/studio/p/p01/state");
  EXPECT_EQ(topic_text(kRoom, {RoomTopicKind::presence, "p01", 0}), "r/home/studio/p/p01/presence");
  EXPECT_EQ(topic_text(kRoom, {RoomTopicKind::chat, "p01", 0}), "r/home/studio/p/p01/chat");
  EXPECT_EQ(topic_text(kRoom, {RoomTopicKind::board, "p01", 63}), "r/home/studio/p/p01/board/63");
  EXPECT_EQ(topic_text(kRoom, {}), "r/home/studio/room");
  EXPECT_EQ(presence_filter(kRoom), "r/home/studio/p/+/presence");
}

TEST(RoomTopic, IsReadBack) {
  for (const RoomTopicKind kind : {RoomTopicKind::pose, RoomTopicKind::state, RoomTopicKind::presence,
                                   RoomTopicKind::chat, RoomTopicKind::board}) {
    for (const char* const participant : {"p01", "a", "x_-9"}) {
      const auto read = read_topic(kRoom, topic_text(kRoom, {kind, participant, 7}));
      ASSERT_TRUE(read);
      EXPECT_EQ(read->kind, kind);
      EXPECT_EQ(read->participant, participant);
      EXPECT_EQ(read->page, kind == RoomTopicKind::board ? 7 : 0);
    }
  }
  ASSERT_TRUE(read_topic(kRoom, "r/home/studio/room"));
  EXPECT_EQ(read_topic(kRoom, "r/home/studio/room")->kind, RoomTopicKind::room);
}

TEST(RoomTopic, OthersAreNone) {
  for (const char* const text : {"",
                                 "r",
                                 "r/home",
                                 "r/home/studio",
                                 "r/home/studio/",
                                 "r/home/studio/rooms",
                                 "r/home/other/room",
                                 "R/home/studio/room",
                                 "/r/home/studio/room",
                                 "r/home/studio/p",
                                 "r/home/studio/p/",
                                 "r/home/studio/p/a",
                                 "r/home/studio/p/a/",
                                 "r/home/studio/p//pose",
                                 "r/home/studio/p/A/pose",
                                 "r/home/studio/p/a.b/pose",
                                 "r/home/studio/p/a/pose/",
                                 "r/home/studio/p/a/poses",
                                 "r/home/studio/p/a/board",
                                 "r/home/studio/p/a/board/",
                                 "r/home/studio/p/a/board/64",
                                 "r/home/studio/p/a/board/-1",
                                 "r/home/studio/p/a/board/01",
                                 "r/home/studio/p/a/board/+1",
                                 "r/home/studio/p/a/board/1/2",
                                 "r/home/studio/p/+/pose",
                                 "r/home/studio/#",
                                 "r/home/studio/p/a23456789012345678901234567890123/pose"}) {
    EXPECT_FALSE(read_topic(kRoom, text)) << text;
  }
}

TEST(RoomTopic, SegmentsAreSmall) {
  for (const char* const good : {"a", "0", "_", "-", "room_1", "abcdefghijklmnopqrstuvwxyz012345"}) {
    EXPECT_TRUE(is_room_segment(good)) << good;
  }
  for (const char* const bad : {"", "A", "a b", "a/b", "a.b", "+", "#", "$sys", "\xc3\xa4", "a\n",
                                "abcdefghijklmnopqrstuvwxyz0123456"}) {
    EXPECT_FALSE(is_room_segment(bad)) << bad;
    EXPECT_THROW(topic_text({bad, "studio"}, {}), Error);
    EXPECT_THROW(topic_text({"home", bad}, {}), Error);
    EXPECT_THROW(topic_text(kRoom, {RoomTopicKind::pose, bad, 0}), Error);
    EXPECT_THROW(presence_filter({"home", bad}), Error);
  }
  EXPECT_FALSE(is_room_segment(std::string_view("a\0", 2)));
  EXPECT_THROW(topic_text(kRoom, {RoomTopicKind::board, "a", 64}), Error);
  EXPECT_THROW(topic_text(kRoom, {RoomTopicKind::board, "a", -1}), Error);
}

TEST(RoomTopic, UsersAreOfARoom) {
  EXPECT_EQ(participant_of_user(kRoom, "studio.p01"), "p01");
  for (const char* const user : {"", "studio", "studio.", ".p01", "other.p01", "studio.p.01", "studio.P"}) {
    EXPECT_FALSE(participant_of_user(kRoom, user)) << user;
  }
}

}  // namespace
}  // namespace telemime
