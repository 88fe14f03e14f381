// SPDX-License-Identifier: Apache-2.0
// Senders whose connections break, and senders that end.
#include <gtest/gtest.h>

#include "broker.h"
#include "checks.h"
#include "feeder.h"
#include "meeting/protocol/messages.h"
#include "meeting/transport/senders.h"
#include "relay.h"

namespace telemime::meeting::test_support {
namespace {

using testing_receivers::ends_at_once;

std::string through(const Relay& relay) {
  return "mqtt://127.0.0.1:" + std::to_string(relay.port()) + "/home/studio";
}

TEST(BrokenMeeting, RestartedBrokerGetsEverythingAgain) {
  Broker broker;
  const auto sender = make_sender(broker.url() + "?name=Ana", kAllSenderKinds);
  Feeder feeder(*sender);
  std::vector<PoseFrame> before;
  {
    Subscriber subscriber(broker.port());
    ASSERT_TRUE(comes_true([&] { return subscriber.frames("tracker").size() >= 5; }));
    before = subscriber.frames("tracker");
    broker.kill();
  }
  ASSERT_TRUE(comes_true([&] { return sender->status().state == SenderState::failed; }));
  ASSERT_TRUE(comes_true([&] {
    return sender->status().words == "no program is listening there; trying again";
  })) << sender->status().words;
  EXPECT_EQ(sender->status().receivers, 0);
  const std::int64_t dropped = sender->status().dropped;
  EXPECT_TRUE(comes_true([&] { return sender->status().dropped > dropped; })) << "the oldest give way";
  broker.start();
  Subscriber subscriber(broker.port());
  ASSERT_TRUE(comes_true([&] { return !subscriber.frames("tracker").empty(); }));
  EXPECT_TRUE(is_sending(*sender));
  EXPECT_TRUE(is_here(subscriber, "tracker", true));
  const auto state = read_state(subscriber.newest("p/tracker/state")->payload);
  ASSERT_TRUE(state);
  EXPECT_EQ(state->name, "Ana");
  EXPECT_TRUE(comes_true([&] { return subscriber.json("p/tracker/state").contains("bones"); }));
  const PoseFrame after = subscriber.frames("tracker").front();
  EXPECT_EQ(after.session, before.back().session) << "the publisher is the same";
  EXPECT_GT(after.sequence, before.back().sequence);
  EXPECT_GT(after.captured, before.back().captured);
}

TEST(BrokenMeeting, LastWillReportsTheAbsence) {
  Broker broker;
  Subscriber subscriber(broker.port());
  Relay relay(broker.port());
  const auto sender = make_sender(through(relay), kAllSenderKinds);
  ASSERT_TRUE(is_here(subscriber, "tracker", true) && is_sending(*sender));
  const std::uint16_t session = subscriber.json("p/tracker/presence").at("session");
  relay.cut_sender();
  relay.cut_broker();
  EXPECT_TRUE(was_published(subscriber, "p/tracker/presence", write_presence({false, session})));
  EXPECT_TRUE(is_here(subscriber, "tracker", true)) << "and then they are back";
  EXPECT_GE(relay.made(), 2);
}

TEST(BrokenMeeting, OlderLastWillIsContradicted) {
  Broker broker;
  Subscriber subscriber(broker.port());
  Relay relay(broker.port());
  const auto sender = make_sender(through(relay), kAllSenderKinds);
  ASSERT_TRUE(is_here(subscriber, "tracker", true) && is_sending(*sender));
  const std::uint16_t session = subscriber.json("p/tracker/presence").at("session");
  relay.cut_sender();  // the broker does not know yet
  ASSERT_TRUE(comes_true([&] { return relay.made() >= 2; }));
  ASSERT_TRUE(is_sending(*sender));
  subscriber.clear();
  relay.cut_broker();
  ASSERT_TRUE(was_published(subscriber, "p/tracker/presence", write_presence({false, session})))
      << "the will";
  EXPECT_TRUE(is_here(subscriber, "tracker", true)) << "is contradicted";
}

TEST(BrokenMeeting, ProperEndLeavesNothingBehind) {
  Broker broker;
  Subscriber subscriber(broker.port());
  {
    auto sender = make_sender(broker.url(), kAllSenderKinds);
    const Feeder feeder(*sender);
    ASSERT_TRUE(is_here(subscriber, "tracker", true));
    ASSERT_TRUE(comes_true([&] { return !subscriber.frames("tracker").empty(); }));
  }
  ASSERT_TRUE(is_here(subscriber, "tracker", false));
  ASSERT_TRUE(comes_true([&] { return subscriber.newest("p/tracker/state")->payload.empty(); }));
  Subscriber late(broker.port());
  ASSERT_TRUE(comes_true([&] { return late.newest("p/tracker/presence").has_value(); }));
  EXPECT_FALSE(late.newest("p/tracker/state")) << "nothing is kept of it";
}

TEST(BrokenMeeting, EndsAtOnceWhenNobodyReads) {
  Broker broker;
  Relay relay(broker.port());
  auto sender = make_sender(through(relay), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender));
  relay.stall();
  EXPECT_TRUE(ends_at_once(std::move(sender)));
}

TEST(SlowMeeting, BrokerThatDoesNotReadIsReported) {
  Broker broker;
  Relay relay(broker.port());
  const auto sender = make_sender(through(relay), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender));
  Feeder feeder(*sender);
  relay.stall();
  ASSERT_TRUE(comes_true([&] { return sender->status().state == SenderState::failed; }))
      << "neither by its silence nor by what it does not read";
  const std::string text = sender->status().words;
  EXPECT_TRUE(text.starts_with("it does not") || text.starts_with("it stopped answering")) << text;
}

TEST(BrokenMeeting, ClearedMessagesArePublishedAgain) {
  Broker broker;
  const auto sender = make_sender(broker.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender));
  Subscriber subscriber(broker.port());
  ASSERT_TRUE(is_here(subscriber, "tracker", true));
  subscriber.publish("p/tracker/state", "");
  subscriber.publish("p/tracker/presence", "");
  EXPECT_TRUE(was_published(subscriber, "p/tracker/presence", ""));
  EXPECT_TRUE(comes_true([&] {
    const auto presence = subscriber.newest("p/tracker/presence");
    return presence && !presence->payload.empty();
  }));
  EXPECT_TRUE(comes_true([&] { return !subscriber.newest("p/tracker/state")->payload.empty(); }));
}

/// Number of presence messages of "tracker", which repeats its presence once per second without frames.
std::size_t presences(const Subscriber& subscriber) {
  return subscriber.payloads("p/tracker/presence").size();
}

TEST(BrokenMeeting, PageThatGivesWayIsNoDuplicate) {
  Broker broker;
  Subscriber subscriber(broker.port());
  const auto sender = make_sender(broker.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender) && is_here(subscriber, "tracker", true));
  const std::uint16_t session = subscriber.json("p/tracker/presence").at("session");
  const std::uint16_t page = session == 1 ? 2 : 1;
  subscriber.publish("p/tracker/presence", write_presence({true, page, 3.0}));  // was on its way
  ASSERT_TRUE(comes_true([&] { return presences(subscriber) >= 4; }));
  EXPECT_EQ(sender->status().words, "");
  // It had taken the place of a tracker that was not heard for a while, and gives it back.
  subscriber.publish("p/tracker/presence", write_presence({true, page, 3.0}));
  ASSERT_TRUE(comes_true([&] { return sender->status().words.find("another client") == 0; }));
  subscriber.clear();
  subscriber.publish("p/tracker/presence", write_presence({false, page}));
  EXPECT_TRUE(comes_true([&] { return sender->status().words.empty(); })) << sender->status().words;
  EXPECT_TRUE(comes_true([&] { return subscriber.newest("p/tracker/state").has_value(); }));
  EXPECT_TRUE(is_here(subscriber, "tracker", true));
  EXPECT_EQ(subscriber.json("p/tracker/presence").at("session"), session);
}

TEST(BrokenMeeting, DuplicateParticipantIsReported) {
  Broker broker;
  const auto sender = make_sender(broker.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender));
  Subscriber subscriber(broker.port());
  ASSERT_TRUE(comes_true([&] { return presences(subscriber) >= 3; }));
  {
    const auto twin = make_sender(broker.url(), kAllSenderKinds);
    ASSERT_TRUE(comes_true([&] {
      return sender->status().words == "another client takes part as \"tracker\"";
    })) << sender->status().words;
  }
  EXPECT_TRUE(is_here(subscriber, "tracker", true)) << "the one who stays is still here";
  EXPECT_TRUE(comes_true([&] { return sender->status().words.empty(); })) << sender->status().words;
}

}  // namespace
}  // namespace telemime::meeting::test_support
