// SPDX-License-Identifier: Apache-2.0
// Senders whose connections break, and senders that end.
#include <gtest/gtest.h>

#include <algorithm>

#include "broker.h"
#include "feeder.h"
#include "meeting/protocol/messages.h"
#include "meeting/transport/senders.h"
#include "relay.h"
#include "subscriber.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime::meeting::test_support {
namespace {

using testing_receivers::comes_true;
using testing_receivers::ends_at_once;

bool is_sending(const Sender& sender) {
  return comes_true([&] { return sender.status().state == SenderState::sending; });
}

std::string through(const Relay& relay) {
  return "mqtt://127.0.0.1:" + std::to_string(relay.port()) + "/home/studio";
}

/// Whether the newest presence of the tracker comes to say this.
bool says_here(const Subscriber& ear, bool here) {
  return comes_true([&] {
    const auto presence = ear.json("p/tracker/presence");
    return presence.is_object() && presence.at("here") == here;
  });
}

/// Whether the tracker's presence comes to be told so, be it for a moment.
bool was_said(const Subscriber& ear, const std::string& presence) {
  return comes_true([&] {
    const std::vector<Subscriber::Heard> all = ear.all();
    return std::any_of(all.begin(), all.end(), [&](const Subscriber::Heard& heard) {
      return heard.topic == "p/tracker/presence" && heard.payload == presence;
    });
  });
}

TEST(BrokenMeeting, ABrokerThatComesBackIsToldAllAgain) {
  Broker broker;
  const auto sender = make_sender(broker.url() + "?name=Ana", kAllSenderKinds);
  Feeder feeder(*sender);
  std::vector<PoseFrame> before;
  {
    Subscriber ear(broker.port());
    ASSERT_TRUE(comes_true([&] { return ear.frames("tracker").size() >= 5; }));
    before = ear.frames("tracker");
    broker.kill();
  }
  ASSERT_TRUE(comes_true([&] { return sender->status().state == SenderState::failed; }));
  ASSERT_TRUE(comes_true([&] { return sender->status().words == "nobody listens there; trying again"; }))
      << sender->status().words;
  EXPECT_EQ(sender->status().receivers, 0);
  const std::int64_t dropped = sender->status().dropped;
  EXPECT_TRUE(comes_true([&] { return sender->status().dropped > dropped; })) << "the oldest give way";
  broker.start();
  Subscriber ear(broker.port());
  ASSERT_TRUE(comes_true([&] { return !ear.frames("tracker").empty(); }));
  EXPECT_TRUE(is_sending(*sender));
  EXPECT_TRUE(says_here(ear, true));
  const auto state = read_state(ear.newest("p/tracker/state")->payload);
  ASSERT_TRUE(state);
  EXPECT_EQ(state->name, "Ana");
  EXPECT_TRUE(comes_true([&] { return ear.json("p/tracker/state").contains("bones"); }));
  const PoseFrame after = ear.frames("tracker").front();
  EXPECT_EQ(after.session, before.back().session) << "the publisher is the same";
  EXPECT_GT(after.sequence, before.back().sequence);
  EXPECT_GT(after.captured, before.back().captured);
}

TEST(BrokenMeeting, TheWillSaysThatTheyAreGone) {
  Broker broker;
  Subscriber ear(broker.port());
  Relay relay(broker.port());
  const auto sender = make_sender(through(relay), kAllSenderKinds);
  ASSERT_TRUE(says_here(ear, true) && is_sending(*sender));
  const std::uint16_t session = ear.json("p/tracker/presence").at("session");
  relay.cut_sender();
  relay.cut_broker();
  EXPECT_TRUE(was_said(ear, write_presence({false, session})));
  EXPECT_TRUE(says_here(ear, true)) << "and then they are back";
  EXPECT_GE(relay.made(), 2);
}

TEST(BrokenMeeting, TheWillOfAnOlderConnectionOfOursHarmsNobody) {
  Broker broker;
  Subscriber ear(broker.port());
  Relay relay(broker.port());
  const auto sender = make_sender(through(relay), kAllSenderKinds);
  ASSERT_TRUE(says_here(ear, true) && is_sending(*sender));
  const std::uint16_t session = ear.json("p/tracker/presence").at("session");
  relay.cut_sender();  // the broker does not know yet
  ASSERT_TRUE(comes_true([&] { return relay.made() >= 2; }));
  ASSERT_TRUE(is_sending(*sender));
  ear.forget();
  relay.cut_broker();
  ASSERT_TRUE(was_said(ear, write_presence({false, session}))) << "the will";
  EXPECT_TRUE(says_here(ear, true)) << "is contradicted";
}

TEST(BrokenMeeting, AnOrderlyEndLeavesNothingBehind) {
  Broker broker;
  Subscriber ear(broker.port());
  {
    auto sender = make_sender(broker.url(), kAllSenderKinds);
    const Feeder feeder(*sender);
    ASSERT_TRUE(says_here(ear, true));
    ASSERT_TRUE(comes_true([&] { return !ear.frames("tracker").empty(); }));
  }
  ASSERT_TRUE(says_here(ear, false));
  ASSERT_TRUE(comes_true([&] { return ear.newest("p/tracker/state")->payload.empty(); }));
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

TEST(SlowMeeting, ABrokerThatDoesNotReadIsToldAndGivenUp) {
  Broker broker;
  Relay relay(broker.port());
  const auto sender = make_sender(through(relay), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender));
  Feeder feeder(*sender);
  relay.stall();
  ASSERT_TRUE(comes_true([&] { return sender->status().state == SenderState::failed; }))
      << "neither by its silence nor by what it does not read";
  const std::string words = sender->status().words;
  EXPECT_TRUE(words.starts_with("it does not") || words.starts_with("no answer")) << words;
}

TEST(BrokenMeeting, WhatWasClearedAwayIsToldAgain) {
  Broker broker;
  const auto sender = make_sender(broker.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender));
  Subscriber ear(broker.port());
  ASSERT_TRUE(says_here(ear, true));
  ear.say("p/tracker/state", "");
  ear.say("p/tracker/presence", "");
  EXPECT_TRUE(was_said(ear, ""));
  EXPECT_TRUE(comes_true([&] {
    const auto presence = ear.newest("p/tracker/presence");
    return presence && !presence->payload.empty();
  }));
  EXPECT_TRUE(comes_true([&] { return !ear.newest("p/tracker/state")->payload.empty(); }));
}

/// How often "tracker" has said that it is here; without frames it does so once a second.
std::ptrdiff_t breaths(const Subscriber& ear) {
  const std::vector<Subscriber::Heard> heard = ear.all();
  return std::count_if(heard.begin(), heard.end(),
                       [](const Subscriber::Heard& one) { return one.topic == "p/tracker/presence"; });
}

TEST(BrokenMeeting, APageThatMakesRoomIsNobodyElse) {
  Broker broker;
  Subscriber ear(broker.port());
  ASSERT_TRUE(comes_true([&] { return ear.listens(); }));
  const auto sender = make_sender(broker.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender) && says_here(ear, true));
  const std::uint16_t session = ear.json("p/tracker/presence").at("session");
  const std::uint16_t page = session == 1 ? 2 : 1;
  ear.say("p/tracker/presence", write_presence({true, page, 3.0}));  // was on its way
  ASSERT_TRUE(comes_true([&] { return breaths(ear) >= 4; }));
  EXPECT_EQ(sender->status().words, "");
  // It had taken the place of a tracker that was not heard for a while, and gives it back.
  ear.say("p/tracker/presence", write_presence({true, page, 3.0}));
  ASSERT_TRUE(comes_true([&] { return sender->status().words.find("somebody else") == 0; }));
  ear.forget();
  ear.say("p/tracker/presence", write_presence({false, page}));
  EXPECT_TRUE(comes_true([&] { return sender->status().words.empty(); })) << sender->status().words;
  EXPECT_TRUE(comes_true([&] { return ear.newest("p/tracker/state").has_value(); }));
  EXPECT_TRUE(says_here(ear, true));
  EXPECT_EQ(ear.json("p/tracker/presence").at("session"), session);
}

TEST(BrokenMeeting, TwoOfOneNameAreTold) {
  Broker broker;
  const auto sender = make_sender(broker.url(), kAllSenderKinds);
  ASSERT_TRUE(is_sending(*sender));
  Subscriber ear(broker.port());
  ASSERT_TRUE(comes_true([&] { return breaths(ear) >= 3; }));
  {
    const auto twin = make_sender(broker.url(), kAllSenderKinds);
    ASSERT_TRUE(comes_true([&] {
      return sender->status().words == "somebody else takes part as \"tracker\", too";
    })) << sender->status().words;
  }
  EXPECT_TRUE(says_here(ear, true)) << "the one who stays is still here";
  EXPECT_TRUE(comes_true([&] { return sender->status().words.empty(); })) << sender->status().words;
}

}  // namespace
}  // namespace telemime::meeting::test_support
