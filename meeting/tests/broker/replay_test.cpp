// SPDX-License-Identifier: Apache-2.0
// Replaying recordings.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <map>
#include <optional>
#include <thread>

#include "broker.h"
#include "checks.h"
#include "feeder.h"
#include "meeting/transport/replay_participant.h"
#include "meeting/transport/senders.h"
#include "recordings.h"
#include "relay.h"
#include "telemime/core/errors.h"
#include "telemime/core/scratch_folder.h"

namespace telemime::meeting::test_support {
namespace {

/// Expects the frames of the recording, bit for bit except for session, sequence and time, with the same time
/// differences. `count`: number of frames sent.
void expect_same_motion(const std::vector<std::string>& source, const std::vector<std::string>& arrived,
                        std::uint64_t count) {
  ASSERT_EQ(arrived.size(), count);
  ASSERT_FALSE(arrived.empty());
  const PoseFrame first = frame_of(source.at(0));
  std::optional<std::uint64_t> shift;
  for (const std::string& bytes : arrived) {
    const PoseFrame frame = frame_of(bytes);
    ASSERT_LT(frame.sequence, source.size());
    const std::string& original = source[frame.sequence];
    EXPECT_EQ(bytes.substr(0, 2), original.substr(0, 2));
    EXPECT_EQ(bytes.substr(16), original.substr(16));
    EXPECT_EQ(frame.session, frame_of(arrived[0]).session);
    const std::uint64_t now = frame.captured - (frame_of(original).captured - first.captured);
    shift = shift.value_or(now);
    EXPECT_EQ(now, *shift) << "differences of time are kept";
  }
}

std::vector<ReplayedParticipant> replay(const ReplayOptions& options) {
  return replay_recording(
      options, [] { return false; }, [](const std::string&) {});
}

std::string refusal(const ReplayOptions& options) {
  return error_of([&] { replay(options); });
}

TEST(Replay, ReplaysWhatWasRecorded) {
  const ScratchFolder folder;
  const std::string file = folder.file("a.troom");
  {
    const Broker broker;
    Subscriber subscriber(broker.port());
    subscriber.publish("room", R"({"v":1,"epoch":4})");
    subscriber.publish("p/p02/board/3", R"({"v":1,"epoch":4,"strokes":[]})");
    const auto ana = make_sender(broker.url() + "?participant=p01&name=Ana&look=robot", kAllSenderKinds);
    const auto bo = make_sender(broker.url() + "?participant=p02&name=Bo&seat=5", kAllSenderKinds);
    Recording recording(broker.url(), file);
    ASSERT_TRUE(recording.has(4)) << "retained messages come first";
    subscriber.clear();
    const Feeder feeds_ana(*ana);
    const Feeder feeds_bo(*bo);
    ASSERT_TRUE(comes_true(
        [&] { return subscriber.frames("p01").size() >= 30 && subscriber.frames("p02").size() >= 30; }));
    subscriber.publish("p/p01/chat", R"({"v":1,"id":"77-1","text":"hello"})");
    ASSERT_TRUE(comes_true([&] { return subscriber.newest("p/p01/chat").has_value(); }));
    ASSERT_TRUE(recording.has(64));
    recording.end();
    const auto poses = recorded(file, "p01", TopicKind::pose);
    const auto sent = subscriber.payloads("p/p01/pose");
    ASSERT_GE(poses.size(), 30U);
    EXPECT_TRUE(std::search(poses.begin(), poses.end(), sent.begin(), sent.begin() + 25) != poses.end())
        << "the file contains what was received";
  }
  EXPECT_EQ(inspect_recording(file).complaint, "");
  const Broker broker;
  Subscriber subscriber(broker.port());
  subscriber.publish("room", R"({"v":1,"epoch":9})");
  ASSERT_TRUE(comes_true([&] { return subscriber.newest("room").has_value(); }));
  const auto people = replay(replay_to(broker.url(), file));
  ASSERT_EQ(people.size(), 2U);
  ASSERT_TRUE(has_left(subscriber, "p01"));
  ASSERT_TRUE(has_left(subscriber, "p02"));
  for (const ReplayedParticipant& person : people) {
    const auto source = recorded(file, person.recorded, TopicKind::pose);
    EXPECT_EQ(person.participant, person.recorded);
    EXPECT_EQ(person.status.frames + person.status.dropped, source.size());
    expect_same_motion(source, subscriber.payloads("p/" + person.recorded + "/pose"), person.status.frames);
  }
  const auto states = subscriber.payloads("p/p01/state");
  ASSERT_FALSE(states.empty());
  const auto ana = read_state(states[0]);
  ASSERT_TRUE(ana);
  EXPECT_EQ(ana->name, "Ana");
  EXPECT_EQ(std::get<AvatarByLook>(ana->avatar).look, "robot");
  EXPECT_EQ(ana->session, frame_of(subscriber.payloads("p/p01/pose").at(0)).session);
  EXPECT_EQ(read_state(subscriber.payloads("p/p02/state").at(0))->seat, 5);
  EXPECT_EQ(subscriber.json("p/p02/board/3"), nlohmann::json::parse(R"({"v":1,"epoch":9,"strokes":[]})"));
  EXPECT_EQ(subscriber.json("p/p01/chat").at("text"), "hello");
  EXPECT_EQ(subscriber.json("room").at("epoch"), 9) << "the message of the meeting is not replayed";
}

TEST(Replay, OnlyNamedParticipantsJoin) {
  const ScratchFolder folder;
  const std::string file = write_test_recording(folder.file("a.troom"), 3, 5);
  const Broker broker;
  const Subscriber subscriber(broker.port());
  const auto people = replay(replay_to(broker.url(), file, {"Q1", "q2"}));
  ASSERT_EQ(people.size(), 2U);
  EXPECT_EQ(people[0].recorded, "q1");
  EXPECT_EQ(people[1].recorded, "q2");
  ASSERT_TRUE(has_left(subscriber, "q1"));
  ASSERT_TRUE(has_left(subscriber, "q2"));
  EXPECT_EQ(subscriber.frames("q1").size(), 5U);
  EXPECT_FALSE(subscriber.newest("p/q0/presence")) << "nobody else is there";
  const std::string text = refusal(replay_to(broker.url(), file, {"Zoe"}));
  EXPECT_NE(text.find("\"Zoe\" is not in the recording"), std::string::npos) << text;
  EXPECT_NE(text.find("q0 \"Q0\", q1 \"Q1\""), std::string::npos) << text;
}

TEST(Replay, LinkGivesEveryoneASeat) {
  const ScratchFolder folder;
  const std::string file = write_test_recording(folder.file("a.troom"), 2, 5);
  const std::string rights = kWatches + "topic readwrite r/home/studio/p/";
  const Broker broker({{"studio.p05", "a", rights + "p05/#\n"},
                       {"studio.p06", "b", rights + "p06/#\n"},
                       {"studio.watch", "c", kWatches}});
  const Subscriber subscriber(broker.port(), "studio.watch", "c");
  std::vector<Credentials> keys;
  for (const auto& [who, password] : {std::pair("p06", "b"), std::pair("p05", "a")}) {
    keys.push_back({"mqtt://127.0.0.1:" + std::to_string(broker.port()), "studio." + std::string(who),
                    password, "r/home/studio", who, ""});
  }
  ReplayOptions options = replay_to("http://localhost:7080/room#k=invitation", file);
  options.log_in = [&](const LinkLogin& entry) {
    EXPECT_EQ(entry.link, "http://localhost:7080/room#k=invitation");
    EXPECT_FALSE(entry.watch);
    if (keys.empty()) {
      throw Error(ErrorKind::input, "no seat is free");
    }
    Credentials key = keys.back();
    keys.pop_back();
    return key;
  };
  const auto people = replay(options);
  ASSERT_EQ(people.size(), 2U);
  EXPECT_EQ(people[0].participant, "p05");
  EXPECT_EQ(people[1].participant, "p06");
  ASSERT_TRUE(has_left(subscriber, "p05"));
  EXPECT_EQ(subscriber.frames("p05").size(), 5U);
  EXPECT_EQ(read_state(subscriber.payloads("p/p06/state").at(0))->name, "Q1");
  EXPECT_NE(refusal(options).find("no seat is free"), std::string::npos);
}

TEST(Replay, AccountWithoutRightsIsRejected) {
  const ScratchFolder folder;
  const std::string file = write_test_recording(folder.file("a.troom"), 2, 5);
  const std::string rights = kWatches + "topic readwrite r/home/studio/p/q0/#\n";
  const Broker broker({{"studio.q0", "a", rights}});
  const std::string text = refusal(replay_to(broker.url("studio.q0:a@"), file));
  EXPECT_NE(text.find("\"q1\" cannot take part"), std::string::npos) << text;
  EXPECT_NE(text.find("the account may not publish as"), std::string::npos) << text;
  EXPECT_NE(text.find("needs an account that may publish for all participants"), std::string::npos) << text;
  EXPECT_EQ(text.find(":a@"), std::string::npos) << text;
}

TEST(Replay, ExistingParticipantIsNotReplaced) {
  const ScratchFolder folder;
  const std::string file = write_test_recording(folder.file("a.troom"), 1, 5);
  const Broker broker;
  const auto sender = make_sender(broker.url() + "?participant=q0", kAllSenderKinds);
  ASSERT_TRUE(comes_true([&] { return sender->status().state == SenderState::sending; }));
  const std::string text = refusal(replay_to(broker.url(), file));
  EXPECT_NE(text.find("another client takes part as \"q0\""), std::string::npos) << text;
  const Subscriber subscriber(broker.port());
  EXPECT_TRUE(comes_true([&] {
    const auto presence = subscriber.json("p/q0/presence");
    return presence.is_object() && presence.at("here") == true;
  })) << "and stays";
}

TEST(Replay, SlowBrokerDelaysNothing) {
  const ScratchFolder folder;
  const std::string file = write_test_recording(folder.file("a.troom"), 1, 30, 16'000);
  const Broker broker;
  Relay relay(broker.port());
  std::atomic<bool> over = false;
  std::vector<ReplayedParticipant> people;
  const ReplayOptions options =
      replay_to("mqtt://127.0.0.1:" + std::to_string(relay.port()) + "/home/studio", file);
  std::thread thread([&] {
    people = replay_recording(
        options, [] { return false; }, [&](const std::string&) { relay.stall(); });  // everyone has joined
    over = true;
  });
  EXPECT_TRUE(comes_true([&] { return over.load(); }));
  thread.join();
  ASSERT_EQ(people.size(), 1U);
  EXPECT_GE(people[0].status.dropped, 30 - kQueuedPoses - 1);
}

TEST(Replay, DetailsWaitAndGoWithTheirFrames) {
  const BrokerLogin nowhere{
      .server = {.host = "127.0.0.1", .port = 1, .ca_file = {}, .user = {}, .password = {}},
      .meeting = {"home", "studio"},
      .participant = "p01",
      .warning = {}};
  constexpr std::uint16_t kSession = 7;
  for (const bool sent : {false, true}) {
    ReplayParticipant person(nowhere, kSession);
    const auto publish = [&person](const char* version) {
      person.publish({TopicKind::pose, 0, kSession, false, version});
    };
    if (sent) {
      publish("\x02");  // of a frame that was taken before it came
    }
    for (int i = 0; i < 10; ++i) {
      publish("\x01");  // a frame
      publish("\x02");  // its detail
    }
    EXPECT_EQ(person.status().dropped, 10 - kQueuedPoses);
    person.publish({TopicKind::presence, 0, kSession + 1, true, ""});
    EXPECT_EQ(person.status().dropped, 10U);
  }
}

TEST(Replay, RestartedBrokerGetsEverythingAgain) {
  const ScratchFolder folder;
  const std::string file = write_test_recording(folder.file("a.troom"), 1, 100'000);
  Broker broker;
  std::atomic<bool> stop = false;
  std::thread thread([&] {
    replay_recording(
        replay_to(broker.url(), file), [&] { return stop.load(); }, [](const std::string&) {});
  });
  {
    const Subscriber subscriber(broker.port());
    ASSERT_TRUE(comes_true([&] { return subscriber.frames("q0").size() > 3; }));
    broker.kill();
  }
  broker.start();
  const Subscriber subscriber(broker.port());
  EXPECT_TRUE(comes_true([&] { return subscriber.frames("q0").size() > 3; }));
  const auto state = subscriber.newest("p/q0/state");
  EXPECT_TRUE(state && read_state(state->payload)->name == "Q0");
  EXPECT_EQ(subscriber.json("p/q0/presence").at("here"), true);
  stop = true;
  thread.join();
  EXPECT_TRUE(has_left(subscriber, "q0")) << "also when it is stopped";
}

TEST(Replay, LoopStartsAgain) {
  const ScratchFolder folder;
  const std::string file = write_test_recording(folder.file("a.troom"), 1, 4);
  const Broker broker;
  const Subscriber subscriber(broker.port());
  std::atomic<bool> stop = false;
  ReplayOptions options = replay_to(broker.url(), file);
  options.speed = 2.0;
  options.loop = true;
  std::thread thread([&] {
    replay_recording(
        options, [&] { return stop.load(); }, [](const std::string&) {});
  });
  std::map<std::uint16_t, std::size_t> sessions;
  EXPECT_TRUE(comes_true([&] {
    sessions.clear();
    for (const PoseFrame& frame : subscriber.frames("q0")) {
      ++sessions[frame.session];
    }
    return sessions.size() >= 3;
  })) << "each time with a session of its own";
  stop = true;
  thread.join();
  EXPECT_TRUE(has_left(subscriber, "q0"));
  const auto frames = subscriber.frames("q0");
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_GT(frames[i].captured, frames[i - 1].captured);
    EXPECT_TRUE(frames[i].session == frames[i - 1].session ? frames[i].sequence > frames[i - 1].sequence
                                                           : frames[i].sequence <= 1);
  }
}

}  // namespace
}  // namespace telemime::meeting::test_support
