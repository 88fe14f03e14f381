// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/topics.h"

#include <gtest/gtest.h>

#include "telemime/core/errors.h"

namespace telemime::meeting {
namespace {

const MeetingAddress kMeeting{"home", "studio"};

TEST(Topic, HasItsText) {
  EXPECT_EQ(topic_text(kMeeting, {TopicKind::pose, "p01", 0}), "r/home/studio/p/p01/pose");
  EXPECT_EQ(topic_text(kMeeting, {TopicKind::state, "p01", 0}), "r/home/studio/p/p01/state");
  EXPECT_EQ(topic_text(kMeeting, {TopicKind::presence, "p01", 0}), "r/home/studio/p/p01/presence");
  EXPECT_EQ(topic_text(kMeeting, {TopicKind::chat, "p01", 0}), "r/home/studio/p/p01/chat");
  EXPECT_EQ(topic_text(kMeeting, {TopicKind::board, "p01", 63}), "r/home/studio/p/p01/board/63");
  EXPECT_EQ(topic_text(kMeeting, {}), "r/home/studio/room");
  EXPECT_EQ(presence_filter(kMeeting), "r/home/studio/p/+/presence");
}

TEST(Topic, IsReadBack) {
  for (const TopicKind kind :
       {TopicKind::pose, TopicKind::state, TopicKind::presence, TopicKind::chat, TopicKind::board}) {
    for (const char* const participant : {"p01", "a", "x_-9"}) {
      const auto read = read_topic(kMeeting, topic_text(kMeeting, {kind, participant, 7}));
      ASSERT_TRUE(read);
      EXPECT_EQ(read->kind, kind);
      EXPECT_EQ(read->participant, participant);
      EXPECT_EQ(read->page, kind == TopicKind::board ? 7 : 0);
    }
  }
  ASSERT_TRUE(read_topic(kMeeting, "r/home/studio/room"));
  EXPECT_EQ(read_topic(kMeeting, "r/home/studio/room")->kind, TopicKind::meeting);
}

TEST(Topic, OtherTextIsRejected) {
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
    EXPECT_FALSE(read_topic(kMeeting, text)) << text;
  }
}

TEST(Topic, SegmentsAreChecked) {
  for (const char* const good : {"a", "0", "_", "-", "room_1", "abcdefghijklmnopqrstuvwxyz012345"}) {
    EXPECT_TRUE(is_topic_segment(good)) << good;
  }
  for (const char* const bad : {"", "A", "a b", "a/b", "a.b", "+", "#", "$sys", "\xc3\xa4", "a\n",
                                "abcdefghijklmnopqrstuvwxyz0123456"}) {
    EXPECT_FALSE(is_topic_segment(bad)) << bad;
    EXPECT_THROW(topic_text({bad, "studio"}, {}), Error);
    EXPECT_THROW(topic_text({"home", bad}, {}), Error);
    EXPECT_THROW(topic_text(kMeeting, {TopicKind::pose, bad, 0}), Error);
    EXPECT_THROW(presence_filter({"home", bad}), Error);
  }
  EXPECT_FALSE(is_topic_segment(std::string_view("a\0", 2)));
  EXPECT_THROW(topic_text(kMeeting, {TopicKind::board, "a", 64}), Error);
  EXPECT_THROW(topic_text(kMeeting, {TopicKind::board, "a", -1}), Error);
}

TEST(Topic, UsersBelongToAMeeting) {
  EXPECT_EQ(participant_of_user(kMeeting, "studio.p01"), "p01");
  for (const char* const user : {"", "studio", "studio.", ".p01", "other.p01", "studio.p.01", "studio.P"}) {
    EXPECT_FALSE(participant_of_user(kMeeting, user)) << user;
  }
}

}  // namespace
}  // namespace telemime::meeting
