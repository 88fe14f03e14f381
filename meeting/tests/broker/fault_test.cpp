// SPDX-License-Identifier: Apache-2.0
// Trackers that die, clocks that jump, and participants who publish invalid messages.
#include <gtest/gtest.h>
#include <mosquitto.h>

#include <algorithm>
#include <atomic>
#include <random>

#include "broker.h"
#include "checks.h"
#include "feeder.h"
#include "meeting/protocol/messages.h"
#include "meeting/transport/senders.h"
#include "tracker_process.h"

namespace telemime::meeting::test_support {
namespace {

constexpr double kMicro = 1e-6;  // s

TEST(MeetingFaults, KilledTrackerIsGoneItsSuccessorIsHere) {
  const Broker broker;
  const Subscriber subscriber(broker.port());
  std::uint16_t session = 0;
  {
    TrackerProcess tracker(broker.url());
    ASSERT_TRUE(has_frames(subscriber, "tracker", 5)) << tracker.output();
    session = subscriber.json("p/tracker/presence").at("session");
    tracker.kill();
  }
  ASSERT_TRUE(is_here(subscriber, "tracker", false));
  EXPECT_EQ(subscriber.json("p/tracker/presence").at("session"), session);
  const std::size_t before = subscriber.frames("tracker").size();
  const TrackerProcess successor(broker.url());
  ASSERT_TRUE(has_frames(subscriber, "tracker", before + 5)) << successor.output();
  EXPECT_TRUE(is_here(subscriber, "tracker", true));
  const PoseFrame first = subscriber.frames("tracker").at(before);
  EXPECT_NE(first.session, session);
  EXPECT_EQ(first.sequence, 0U);
}

TEST(MeetingFaults, WallClockJumpChangesNothing) {
  const Broker broker;
  const Subscriber subscriber(broker.port());
  const TrackerProcess tracker(broker.url());
  ASSERT_TRUE(has_frames(subscriber, "tracker", 10)) << tracker.output();
  // Published with each connection; presence is repeated when there are no frames.
  const auto states = [&subscriber] { return subscriber.payloads("p/tracker/state").size(); };
  const auto at_first = states();
  const auto jumps = [&](int signal, const std::string& line) {
    tracker.signal(signal);
    EXPECT_TRUE(comes_true([&] { return tracker.output().find(line) != std::string::npos; }))
        << tracker.output();
    EXPECT_TRUE(has_frames(subscriber, "tracker", subscriber.frames("tracker").size() + 40));
  };
  jumps(SIGUSR1, "jumped by 3600 s");
  jumps(SIGUSR2, "jumped by -3600 s");  // right again
  jumps(SIGUSR2, "jumped by -3600 s\nthe wall clock jumped by -3600 s");
  const std::vector<PoseFrame> frames = subscriber.frames("tracker");
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].session, frames[0].session);
    EXPECT_EQ(frames[i].sequence, frames[i - 1].sequence + 1);
    const double step = static_cast<double>(frames[i].captured - frames[i - 1].captured) * kMicro;
    EXPECT_GT(step, 0.0);
    EXPECT_LT(step, 60.0) << "no hour between two frames";
  }
  EXPECT_EQ(states(), at_first) << "the connection was never lost";
}

/// Another participant, who publishes anything, with a few messages in flight at a time.
class Publisher {
 public:
  explicit Publisher(std::uint16_t port) : client_(mosquitto_new(nullptr, true, this)) {
    mosquitto_publish_callback_set(client_, [](mosquitto* /*client*/, void* self, int /*id*/) {
      ++static_cast<Publisher*>(self)->confirmed_;
    });
    EXPECT_EQ(mosquitto_connect(client_, "127.0.0.1", port, 60), MOSQ_ERR_SUCCESS);
    EXPECT_EQ(mosquitto_loop_start(client_), MOSQ_ERR_SUCCESS);
  }
  Publisher(const Publisher&) = delete;
  Publisher& operator=(const Publisher&) = delete;
  ~Publisher() {
    mosquitto_disconnect(client_);
    mosquitto_loop_stop(client_, /*force=*/true);
    mosquitto_destroy(client_);
  }
  void publish(const std::string& topic, const std::string& payload) {
    ASSERT_EQ(mosquitto_publish(client_, nullptr, ("r/home/studio/" + topic).c_str(),
                                static_cast<int>(payload.size()), payload.data(), 1, /*retain=*/false),
              MOSQ_ERR_SUCCESS);
    ++published_;
    ASSERT_TRUE(comes_true([&] { return confirmed_ > published_ - kInFlight; }));
  }

 private:
  static constexpr int kInFlight = 20;
  int published_ = 0;
  std::atomic<int> confirmed_ = 0;
  mosquitto* client_;
};

/// An invalid, old, too long or almost valid message.
std::string random_message(std::mt19937& chance) {
  const auto up_to = [&](std::size_t most) {
    return std::uniform_int_distribution<std::size_t>(0, most)(chance);
  };
  std::string text;
  switch (up_to(5)) {
    case 0:
      text.resize(up_to(64));
      std::generate(text.begin(), text.end(), [&] { return static_cast<char>(up_to(255)); });
      return text;
    case 1:
      return std::string(up_to(20000), '[');
    case 2:
      return write_presence({up_to(1) == 1, static_cast<std::uint16_t>(1 + up_to(20))});
    case 3:
      text = write_presence({true, 7});
      text[up_to(text.size() - 1)] = static_cast<char>(up_to(255));
      return text;
    case 4:
      text = write_presence({true, 7});
      return text.substr(0, up_to(text.size()));
    default:
      return R"({"v":1,"here":true,"session":)" + std::to_string(up_to(200000)) + R"(,"x":")" +
             std::string(up_to(300), 'x') + "\"}";
  }
}

TEST(MeetingFaults, RandomMessagesDoNotHarmATracker) {
  constexpr int kMessages = 10000;
  constexpr int kPublishers = 40;
  const Broker broker;
  const auto sender = make_sender(broker.url(), kAllSenderKinds);
  const Feeder feeder(*sender);
  PoseFrame before;
  {
    const Subscriber subscriber(broker.port());
    ASSERT_TRUE(has_frames(subscriber, "tracker", 5)) << sender->status().words;
    before = subscriber.frames("tracker").back();
  }
  Publisher publisher(broker.port());
  std::mt19937 chance(20);
  const auto name = [](int number) { return "p/x" + std::to_string(number); };
  for (int i = 0; i < kMessages && !HasFatalFailure(); ++i) {
    const int who = std::uniform_int_distribution<int>(0, kPublishers - 1)(chance);
    // A tracker reads presence only; other topics must not reach it.
    const bool received = i % 10 != 0;
    publisher.publish(name(who) + (received ? "/presence" : "/pose"), random_message(chance));
  }
  // Repeated, because the broker drops messages that come too fast for a client.
  EXPECT_TRUE(comes_true([&] {
    for (int who = 0; who < kPublishers; ++who) {
      publisher.publish(name(who) + "/presence", "");
    }
    return sender->status().receivers == 0;
  })) << sender->status().receivers;
  for (int who = 0; who < 3; ++who) {
    publisher.publish(name(who) + "/presence", write_presence({true, 9}));
  }
  EXPECT_TRUE(comes_true([&] { return sender->status().receivers == 3; })) << sender->status().receivers;
  EXPECT_EQ(sender->status().state, SenderState::sending) << sender->status().words;
  EXPECT_EQ(sender->status().words, "");
  const Subscriber subscriber(broker.port());
  EXPECT_TRUE(has_frames(subscriber, "tracker", 30));
  for (const PoseFrame& frame : subscriber.frames("tracker")) {
    EXPECT_EQ(frame.session, before.session) << "it never had to start again";
    EXPECT_GT(frame.sequence, before.sequence);
  }
}

}  // namespace
}  // namespace telemime::meeting::test_support
