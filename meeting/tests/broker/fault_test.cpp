// SPDX-License-Identifier: Apache-2.0
// Trackers that die, clocks that jump, and participants who say rubbish.
#include <gtest/gtest.h>
#include <mosquitto.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>

#include "broker.h"
#include "feeder.h"
#include "meeting/protocol/messages.h"
#include "meeting/transport/senders.h"
#include "subscriber.h"
#include "telemime/streaming/testing_receivers.h"
#include "tracker_process.h"

namespace telemime::meeting::test_support {
namespace {

using testing_receivers::comes_true;

constexpr double kMicro = 1e-6;  // s

bool hears(const Subscriber& ear, std::size_t count) {
  return comes_true([&] { return ear.frames("tracker").size() >= count; });
}

bool says_here(const Subscriber& ear, bool here) {
  return comes_true([&] {
    const auto presence = ear.json("p/tracker/presence");
    return presence.is_object() && presence.at("here") == here;
  });
}

TEST(MeetingFaults, ATrackerThatIsKilledIsGoneAndItsSuccessorIsHere) {
  const Broker broker;
  const Subscriber ear(broker.port());
  std::uint16_t session = 0;
  {
    TrackerProcess tracker(broker.url());
    ASSERT_TRUE(hears(ear, 5)) << tracker.output();
    session = ear.json("p/tracker/presence").at("session");
    tracker.kill();
  }
  ASSERT_TRUE(says_here(ear, false));
  EXPECT_EQ(ear.json("p/tracker/presence").at("session"), session);
  const std::size_t before = ear.frames("tracker").size();
  const TrackerProcess successor(broker.url());
  ASSERT_TRUE(hears(ear, before + 5)) << successor.output();
  EXPECT_TRUE(says_here(ear, true));
  const PoseFrame first = ear.frames("tracker").at(before);
  EXPECT_NE(first.session, session);
  EXPECT_EQ(first.sequence, 0U);
}

TEST(MeetingFaults, AWallClockThatJumpsChangesNothing) {
  const Broker broker;
  const Subscriber ear(broker.port());
  const TrackerProcess tracker(broker.url());
  ASSERT_TRUE(hears(ear, 10)) << tracker.output();
  // Told with each connection. Presence is told again when no frame comes for a while.
  const auto states = [&ear] {
    const std::vector<Subscriber::Heard> heard = ear.all();
    return std::count_if(heard.begin(), heard.end(),
                         [](const Subscriber::Heard& one) { return one.topic == "p/tracker/state"; });
  };
  const auto at_first = states();
  const auto jumps = [&](int signal, const std::string& line) {
    tracker.signal(signal);
    EXPECT_TRUE(comes_true([&] { return tracker.output().find(line) != std::string::npos; }))
        << tracker.output();
    EXPECT_TRUE(hears(ear, ear.frames("tracker").size() + 40));
  };
  jumps(SIGUSR1, "jumped by 3600 s");
  jumps(SIGUSR2, "jumped by -3600 s");  // right again
  jumps(SIGUSR2, "jumped by -3600 s\nthe wall clock jumped by -3600 s");
  const std::vector<PoseFrame> frames = ear.frames("tracker");
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i].session, frames[0].session);
    EXPECT_EQ(frames[i].sequence, frames[i - 1].sequence + 1);
    const double step = static_cast<double>(frames[i].captured - frames[i - 1].captured) * kMicro;
    EXPECT_GT(step, 0.0);
    EXPECT_LT(step, 60.0) << "no hour between two pictures";
  }
  EXPECT_EQ(states(), at_first) << "the connection was never lost";
}

/// Another participant, who says what it likes; a few messages are on their way to the broker at a time.
class Stranger {
 public:
  explicit Stranger(std::uint16_t port) : client_(mosquitto_new(nullptr, true, this)) {
    mosquitto_publish_callback_set(client_, [](mosquitto* /*client*/, void* self, int /*id*/) {
      ++static_cast<Stranger*>(self)->taken_;
    });
    EXPECT_EQ(mosquitto_connect(client_, "127.0.0.1", port, 60), MOSQ_ERR_SUCCESS);
    EXPECT_EQ(mosquitto_loop_start(client_), MOSQ_ERR_SUCCESS);
  }
  Stranger(const Stranger&) = delete;
  Stranger& operator=(const Stranger&) = delete;
  ~Stranger() {
    mosquitto_disconnect(client_);
    mosquitto_loop_stop(client_, /*force=*/true);
    mosquitto_destroy(client_);
  }
  void say(const std::string& topic, const std::string& payload) {
    ASSERT_EQ(mosquitto_publish(client_, nullptr, ("r/home/studio/" + topic).c_str(),
                                static_cast<int>(payload.size()), payload.data(), 1, /*retain=*/false),
              MOSQ_ERR_SUCCESS);
    ++said_;
    ASSERT_TRUE(comes_true([&] { return taken_ > said_ - kOnTheirWay; }));
  }

 private:
  static constexpr int kOnTheirWay = 20;
  int said_ = 0;
  std::atomic<int> taken_ = 0;
  mosquitto* client_;
};

/// Something that no participant should say, or that is old, or too long, or almost right.
std::string rubbish(std::mt19937& chance) {
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

TEST(MeetingFaults, TenThousandRandomMessagesHarmNoTracker) {
  constexpr int kMessages = 10000;
  constexpr int kStrangers = 40;
  const Broker broker;
  const auto sender = make_sender(broker.url(), kAllSenderKinds);
  const Feeder feeder(*sender);
  PoseFrame before;
  {
    const Subscriber ear(broker.port());
    ASSERT_TRUE(hears(ear, 5)) << sender->status().words;
    before = ear.frames("tracker").back();
  }
  Stranger stranger(broker.port());
  std::mt19937 chance(20);
  const auto name = [](int number) { return "p/x" + std::to_string(number); };
  for (int i = 0; i < kMessages && !HasFatalFailure(); ++i) {
    const int who = std::uniform_int_distribution<int>(0, kStrangers - 1)(chance);
    // A tracker reads presences alone; what it does not ask for must not reach it.
    const bool heard = i % 10 != 0;
    stranger.say(name(who) + (heard ? "/presence" : "/pose"), rubbish(chance));
  }
  // Again and again: the broker drops what comes too fast for somebody.
  EXPECT_TRUE(comes_true([&] {
    for (int who = 0; who < kStrangers; ++who) {
      stranger.say(name(who) + "/presence", "");
    }
    return sender->status().receivers == 0;
  })) << sender->status().receivers;
  for (int who = 0; who < 3; ++who) {
    stranger.say(name(who) + "/presence", write_presence({true, 9}));
  }
  EXPECT_TRUE(comes_true([&] { return sender->status().receivers == 3; })) << sender->status().receivers;
  EXPECT_EQ(sender->status().state, SenderState::sending) << sender->status().words;
  EXPECT_EQ(sender->status().words, "");
  const Subscriber ear(broker.port());
  EXPECT_TRUE(hears(ear, 30));
  for (const PoseFrame& frame : ear.frames("tracker")) {
    EXPECT_EQ(frame.session, before.session) << "it never had to begin anew";
    EXPECT_GT(frame.sequence, before.sequence);
  }
}

}  // namespace
}  // namespace telemime::meeting::test_support
