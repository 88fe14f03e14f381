// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/session_summary.h"

#include <gtest/gtest.h>

#include "meeting/protocol/room_messages.h"

namespace telemime {
namespace {

SessionMessage message(std::uint64_t at, const std::string& who, RoomTopicKind kind,
                       const std::string& payload) {
  return {at, {kind, who, 0}, payload};
}

std::string state(const std::string& name) {
  ParticipantState state;
  state.name = name;
  return write_state(state);
}

TEST(SessionSummary, KnowsWhoTookPart) {
  SessionSummary summary;
  summary.add(SessionStart{{"home", "studio"}, "today"});
  summary.add(message(1, "", RoomTopicKind::room, "{}"));
  summary.add(message(1, "gone", RoomTopicKind::presence, write_presence({false, 3})));
  summary.add(message(1, "gone", RoomTopicKind::state, ""));
  summary.add(message(1, "lost", RoomTopicKind::presence, write_presence({false, 4})));
  summary.add(message(1, "lost", RoomTopicKind::state, state("Who was killed")));
  summary.add(message(2, "p1", RoomTopicKind::presence, write_presence({true, 3})));
  summary.add(message(3, "p1", RoomTopicKind::state, state("Ana")));
  summary.add(message(4, "p1", RoomTopicKind::state, state("Ana B")));
  summary.add(message(5, "p2", RoomTopicKind::pose, "?"));
  summary.add(message(6, "p3", RoomTopicKind::chat, "?"));
  summary.add(SessionLost{7, "why"});
  summary.add(SessionBack{8});
  summary.add(SessionDropped{9, 4});
  summary.add(SessionEnd{12});
  EXPECT_EQ(summary.start.room.room, "studio");
  ASSERT_EQ(summary.people.size(), 5U);
  EXPECT_FALSE(summary.people.at("gone").takes_part) << "somebody of an earlier day";
  EXPECT_FALSE(summary.people.at("lost").takes_part) << "what the broker kept of them is no sign of life";
  EXPECT_TRUE(summary.people.at("p1").takes_part);
  EXPECT_EQ(summary.people.at("p1").names, (std::set<std::string>{"Ana", "Ana B"}));
  EXPECT_EQ(summary.people.at("p1").others, 3U);
  EXPECT_EQ(summary.people.at("p2").frames, 1U);
  EXPECT_TRUE(summary.people.at("p2").takes_part);
  EXPECT_TRUE(summary.people.at("p3").takes_part);
  EXPECT_EQ(summary.gaps, 1U);
  EXPECT_EQ(summary.dropped, 4U);
  EXPECT_EQ(summary.end, 12U);
}

TEST(SessionSummary, PeopleAreWantedByNameOrParticipant) {
  const RecordedPerson ana{{"Ana", "Ana B"}, 0, 0, true};
  EXPECT_TRUE(is_wanted("p1", ana, {}));
  EXPECT_TRUE(is_wanted("p1", ana, {"p1"}));
  EXPECT_TRUE(is_wanted("p1", ana, {"Bo", "Ana B"}));
  EXPECT_FALSE(is_wanted("p1", ana, {"Bo"}));
}

}  // namespace
}  // namespace telemime
