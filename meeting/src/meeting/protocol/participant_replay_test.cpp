// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/participant_replay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "meeting/protocol/meeting_info.h"
#include "meeting/protocol/messages.h"
#include "meeting/protocol/pose_detail.h"
#include "meeting/protocol/testing.h"
#include "telemime/core/random.h"

namespace telemime::meeting {
namespace {

constexpr std::uint64_t kClock = 9'000'000'000;
constexpr std::uint64_t kMs = 1000;

RecordedMessage message(std::uint64_t at, TopicKind kind, const std::string& payload, int page = 0) {
  return {at, {kind, "p1", page}, payload};
}

RecordedMessage pose(std::uint64_t at, std::uint16_t session, std::uint32_t sequence, std::uint64_t captured,
                     std::int16_t height = 900) {
  PoseFrame frame;
  frame.tracked = true;
  frame.session = session;
  frame.sequence = sequence;
  frame.captured = captured;
  frame.mask = 5;
  frame.hips = {1, height, -3};
  frame.confidence[2] = 7;
  frame.rotation[2] = Eigen::Quaterniond(1.0, 0.2, -0.1, 0.4).normalized();
  return message(at, TopicKind::pose, bytes_of(frame));
}

PoseFrame frame_of(const ReplayStep& step) {
  return meeting::frame_of(step.payload);
}

RecordedMessage here(std::uint64_t at, std::uint16_t session, bool here = true) {
  return message(at, TopicKind::presence, write_presence({here, session}));
}

TEST(ParticipantReplay, FramesKeepEverythingButWhoAndWhen) {
  ParticipantReplay part(1.0, 500, kClock);
  Random random(1);
  std::uint64_t captured = 77;
  std::uint64_t first = 0;
  for (std::uint32_t i = 0; i < 50; ++i) {
    captured += 1 + random.below(50'000);
    first = i == 0 ? captured : first;
    const RecordedMessage said = pose(2000 + 33'000 * i, 31, 1000 + 3 * i, captured, 800 + i);
    const auto step = part.step(said);
    ASSERT_TRUE(step);
    const PoseFrame frame = frame_of(*step);
    EXPECT_EQ(frame.session, 500);
    EXPECT_EQ(step->session, 500);
    EXPECT_EQ(frame.sequence, i);
    EXPECT_EQ(frame.captured, kClock + 2000 + (captured - first));
    EXPECT_EQ(step->payload.substr(0, 2), said.payload.substr(0, 2));
    EXPECT_EQ(step->payload.substr(16), said.payload.substr(16)) << "bit for bit";
  }
}

RecordedMessage detail(std::uint64_t at, std::uint16_t session, std::uint32_t sequence) {
  PoseDetail detail;
  detail.session = session;
  detail.sequence = sequence;
  detail.fingers.emplace().fill(33);
  const auto bytes = encode(detail);
  return message(at, TopicKind::pose, {bytes.begin(), bytes.end()});
}

TEST(ParticipantReplay, DetailsFollowTheirFrame) {
  ParticipantReplay part(1.0, 500, kClock);
  EXPECT_FALSE(part.step(detail(0, 31, 10))) << "without a frame";
  for (std::uint32_t i = 0; i < 5; ++i) {
    ASSERT_TRUE(part.step(pose(1000 * i, 31, 10 + 2 * i, 1 + i)));
    EXPECT_FALSE(part.step(detail(1000 * i, 31, 9 + 2 * i))) << "of another frame";
    EXPECT_FALSE(part.step(detail(1000 * i, 32, 10 + 2 * i))) << "of another session";
    const RecordedMessage said = detail(1000 * i, 31, 10 + 2 * i);
    const auto step = part.step(said);
    ASSERT_TRUE(step);
    const auto read = decode_pose_detail(
        {reinterpret_cast<const std::uint8_t*>(step->payload.data()), step->payload.size()});
    ASSERT_TRUE(read);
    EXPECT_EQ(read->session, 500);
    EXPECT_EQ(read->sequence, i);
    EXPECT_EQ(step->payload.substr(8), said.payload.substr(8)) << "bit for bit";
  }
}

TEST(ParticipantReplay, OldAndInvalidMessagesAreDropped) {
  ParticipantReplay part(1.0, 1, kClock);
  EXPECT_TRUE(part.step(pose(0, 5, 10, 1000)));
  EXPECT_FALSE(part.step(pose(1, 5, 10, 1000))) << "a repeated frame";
  EXPECT_FALSE(part.step(pose(2, 5, 9, 2000)));
  EXPECT_FALSE(part.step(pose(3, 5, 11, 1000)));
  EXPECT_FALSE(part.step(pose(3, 5, 11, kTimeEnd)));
  EXPECT_FALSE(part.step(message(4, TopicKind::pose, "nonsense")));
  EXPECT_FALSE(part.step(message(4, TopicKind::state, "{}")));
  EXPECT_FALSE(part.step(message(4, TopicKind::presence, "{}")));
  EXPECT_FALSE(part.step(message(4, TopicKind::chat, R"({"v":1,"id":7,"text":"x"})")));
  EXPECT_FALSE(part.step(message(4, TopicKind::chat, R"({"v":1,"id":"70000-1","text":"x"})")));
  EXPECT_FALSE(part.step(message(4, TopicKind::board, R"({"v":1})")));
  EXPECT_FALSE(part.step(message(4, TopicKind::meeting, R"({"v":1})")));
  EXPECT_TRUE(part.step(pose(5, 5, 11, 1001)));
}

// The page of somebody whose tracker has ended, or has been away for a while.
TEST(ParticipantReplay, PageReturnsAfterItsTracker) {
  constexpr std::uint64_t kSecond = 1'000'000;
  for (const bool says_goodbye : {true, false}) {
    ParticipantReplay part(1.0, 500, kClock);
    ASSERT_TRUE(part.step(here(0, 5)));             // the page
    ASSERT_TRUE(part.step(pose(10, 6, 40, 1000)));  // the tracker
    EXPECT_FALSE(part.step(here(20, 5))) << "left over";
    if (says_goodbye) {
      ASSERT_TRUE(part.step(here(2 * kSecond, 6, false)));
    }
    const auto back = part.step(here(3 * kSecond, 5));
    ASSERT_TRUE(back && back->here) << says_goodbye;
    EXPECT_FALSE(part.step(pose(4 * kSecond, 6, 41, 2000))) << "of a session that has ended";
    EXPECT_TRUE(part.step(here(7 * kSecond, 5))) << "and stays";
    ASSERT_TRUE(part.step(here(9 * kSecond, 6))) << "the tracker is back";
    EXPECT_TRUE(part.step(pose(10 * kSecond, 6, 42, 3000)));
  }
}

TEST(ParticipantReplay, NewSessionGetsANewNumber) {
  ParticipantReplay part(1.0, UINT16_MAX, kClock);
  EXPECT_EQ(part.step(here(0, 5))->session, UINT16_MAX);
  EXPECT_EQ(part.step(pose(10, 5, 40, 1000))->session, UINT16_MAX);
  const auto next = part.step(here(20, 6));
  ASSERT_TRUE(next && next->here);
  EXPECT_EQ(next->session, 1) << "never 0";
  const auto frame = part.step(pose(30, 6, 7, 5));
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame_of(*frame).sequence, 0U);
  EXPECT_EQ(frame_of(*frame).captured, kClock + 30);
  EXPECT_FALSE(part.step(pose(40, 5, 41, 2000))) << "an old session does not return";
  EXPECT_FALSE(part.step(here(40, 5)));
  EXPECT_FALSE(part.step(here(50, 5, false))) << "a late last will of the old one";
  const auto gone = part.step(here(60, 6, false));
  ASSERT_TRUE(gone);
  EXPECT_FALSE(gone->here);
  EXPECT_EQ(gone->session, 1);
}

TEST(ParticipantReplay, RetainedAbsenceIsNoGoodbye) {
  ParticipantReplay part(1.0, 9, kClock);
  EXPECT_FALSE(part.step(here(0, 5, false))) << "retained by the broker";
  const auto cleared = part.step(message(1, TopicKind::presence, ""));
  ASSERT_TRUE(cleared);
  EXPECT_FALSE(cleared->here);
}

TEST(ParticipantReplay, StatesKeepEverythingButTheSession) {
  ParticipantReplay part(1.0, 9, kClock);
  const std::string said =
      R"({"v":1,"session":5,"kind":"browser","name":"Ána","seat":3,"avatar":{"look":"robot"},)"
      R"("bones":{"hips":[0.123456789012345,1.0,-0.1]},"later":{"a":[1]}})";
  const auto step = part.step(message(0, TopicKind::state, said));
  ASSERT_TRUE(step);
  auto expected = nlohmann::json::parse(said);
  expected["session"] = 9;
  EXPECT_EQ(nlohmann::json::parse(step->payload), expected);
  const auto cleared = part.step(message(1, TopicKind::state, ""));
  ASSERT_TRUE(cleared);
  EXPECT_EQ(cleared->payload, "");
}

TEST(ParticipantReplay, ChatGetsANewIdInEachReplay) {
  const RecordedMessage said = message(0, TopicKind::chat, R"({"v":1,"id":"65535-12","text":"hello"})");
  const auto id_of = [&](std::uint16_t session) {
    ParticipantReplay part(1.0, session, kClock);
    const auto step = part.step(said);
    EXPECT_EQ(part.step(said)->payload, step->payload) << "equal messages stay equal";
    const auto json = nlohmann::json::parse(step->payload);
    EXPECT_EQ(json.at("text"), "hello");
    return json.at("id").get<std::string>();
  };
  EXPECT_EQ(id_of(1), "1-12");
  EXPECT_EQ(id_of(65535), "65535-12");
  EXPECT_EQ(id_of(300), "300-12");
}

TEST(ParticipantReplay, PagesOfAnotherEpochAreDropped) {
  ParticipantReplay part(1.0, 9, kClock);
  const auto page = [](int epoch) {
    return message(0, TopicKind::board, R"({"v":1,"epoch":)" + std::to_string(epoch) + R"(,"strokes":[]})",
                   4);
  };
  EXPECT_TRUE(part.step(page(2))) << "the epoch is not known yet";
  part.set_epoch(*read_epoch(R"({"v":1,"epoch":3})"));
  EXPECT_FALSE(part.step(page(2)));
  const auto step = part.step(page(3));
  ASSERT_TRUE(step);
  EXPECT_EQ(step->page, 4);
  EXPECT_EQ(*page_with_epoch(step->payload, 70), R"({"epoch":70,"strokes":[],"v":1})");
  EXPECT_TRUE(part.step(message(0, TopicKind::board, "", 4))) << "a page may be cleared";
  EXPECT_FALSE(page_with_epoch("[]", 1));
  EXPECT_FALSE(read_epoch(R"({"epoch":-1})"));
  EXPECT_FALSE(read_epoch(std::string(100, '[')));
}

TEST(ParticipantReplay, FasterReplayDropsFramesSlowerDoesNot) {
  for (const double speed : {0.5, 1.0, 4.0}) {
    ParticipantReplay part(speed, 9, kClock);
    std::vector<PoseFrame> frames;
    for (std::uint32_t i = 0; i < 300; ++i) {  // 10 s
      if (const auto step = part.step(pose(i * 100 * kMs / 3, 5, i, 1000 + i * 100 * kMs / 3))) {
        frames.push_back(frame_of(*step));
      }
    }
    EXPECT_EQ(frames.size(), speed > 1.0 ? 75U : 300U);
    for (std::size_t i = 1; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].sequence, i);
      const double step = static_cast<double>(frames[i].captured - frames[i - 1].captured);
      EXPECT_NEAR(step, 1e6 / 30.0 / std::min(speed, 1.0), 2.0);
    }
  }
}

}  // namespace
}  // namespace telemime::meeting
