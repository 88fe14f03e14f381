// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/recording_summary.h"

#include <gtest/gtest.h>

#include "meeting/protocol/messages.h"

namespace telemime::meeting {
namespace {

RecordedMessage message(std::uint64_t at, const std::string& who, TopicKind kind,
                        const std::string& payload) {
  return {at, {kind, who, 0}, payload};
}

std::string state(const std::string& name) {
  ParticipantState state;
  state.name = name;
  return write_state(state);
}

TEST(RecordingSummary, KnowsWhoTookPart) {
  RecordingSummary summary;
  summary.add(RecordingStart{{"home", "studio"}, "today"});
  summary.add(message(1, "", TopicKind::meeting, "{}"));
  summary.add(message(1, "gone", TopicKind::presence, write_presence({false, 3})));
  summary.add(message(1, "gone", TopicKind::state, ""));
  summary.add(message(1, "lost", TopicKind::presence, write_presence({false, 4})));
  summary.add(message(1, "lost", TopicKind::state, state("Who was killed")));
  summary.add(message(2, "p1", TopicKind::presence, write_presence({true, 3})));
  summary.add(message(3, "p1", TopicKind::state, state("Ana")));
  summary.add(message(4, "p1", TopicKind::state, state("Ana B")));
  summary.add(message(5, "p2", TopicKind::pose, "?"));
  summary.add(message(6, "p3", TopicKind::chat, "?"));
  summary.add(ConnectionLost{7, "why"});
  summary.add(ConnectionRestored{8});
  summary.add(MessagesDropped{9, 4});
  summary.add(RecordingEnd{12});
  EXPECT_EQ(summary.start.meeting.meeting, "studio");
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

TEST(RecordingSummary, PeopleAreWantedByNameOrParticipant) {
  const RecordedParticipant ana{{"Ana", "Ana B"}, 0, 0, true};
  EXPECT_TRUE(is_wanted("p1", ana, {}));
  EXPECT_TRUE(is_wanted("p1", ana, {"p1"}));
  EXPECT_TRUE(is_wanted("p1", ana, {"Bo", "Ana B"}));
  EXPECT_FALSE(is_wanted("p1", ana, {"Bo"}));
}

}  // namespace
}  // namespace telemime::meeting
