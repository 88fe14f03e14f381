// SPDX-License-Identifier: Apache-2.0
// What the broker of an open room lets accounts do.
#include <gtest/gtest.h>

#include "broker/subscriber.h"
#include "meeting/hosting/hosted_broker.h"
#include "open_meeting.h"

namespace telemime::meeting::test_support {
namespace {

using Json = nlohmann::json;

const std::string kBase = "r/home/studio/";

class Rights : public ::testing::Test {
 protected:
  /// Whether the rest of the room hears what the account says.
  bool reaches(const Json& account, const std::string& topic, const std::string& payload = "x") {
    const Subscriber ear(port(), watcher_.at("user"), watcher_.at("password"));
    EXPECT_TRUE(comes_true([&] { return ear.newest("room").has_value(); }));
    say(port(), account, kBase + topic, payload);
    // The broker delivers in order: behind this one nothing more comes.
    EXPECT_TRUE(say(port(), ana_, kBase + "p/p01/presence", "end"));
    EXPECT_TRUE(comes_true([&] {
      const auto end = ear.newest("p/p01/presence");
      return end && end->payload == "end" && !end->retained;
    }));
    const auto heard = ear.newest(topic);
    const bool reached = heard && heard->payload == payload;
    say(port(), ana_, kBase + "p/p01/presence", "");
    return reached;
  }
  std::uint16_t port() { return meeting_.host().mqtt_port(); }

  OpenMeeting meeting_;
  Json ana_ = meeting_.newcomer();
  Json bo_ = meeting_.newcomer();
  Json chair_ = meeting_.enter({{"invite", meeting_.chair()}});
  Json watcher_ = meeting_.enter({{"invite", meeting_.watch()}});
};

TEST_F(Rights, ParticipantsSpeakAsThemselvesAlone) {
  for (const char* const what : {"chat", "state", "pose", "board/0", "board/63"}) {
    EXPECT_TRUE(reaches(bo_, std::string("p/p02/") + what)) << what;
  }
  for (const char* const what : {"p/p01/chat", "p/p01/pose", "p/p03/chat", "p/p02/else", "p/p02/board/64",
                                 "p/p02/board/00", "p/p2/chat", "p/p02/chat/more", "room", "else"}) {
    EXPECT_FALSE(reaches(bo_, what)) << what;
  }
}

TEST_F(Rights, WatchersSayNothing) {
  for (const char* const what : {"p/p01/chat", "p/watch/chat", "room", "p/p01/pose"}) {
    EXPECT_FALSE(reaches(watcher_, what)) << what;
  }
}

TEST_F(Rights, ChairsSayWhatTheRoomIs) {
  const std::string told = R"({"v":1,"title":"Red","seats":4,"epoch":2,"chairs":["p03"],"locked":true})";
  EXPECT_TRUE(reaches(chair_, "room", told));
  EXPECT_TRUE(comes_true([&] {
    return meeting_.ask(Json{{"v", 1}, {"invite", meeting_.speak()}}.dump()).status == 423;
  })) << "locked for newcomers";
  EXPECT_EQ(meeting_.enter({{"return", ana_.at("return")}}).at("participant"), "p01") << "not for who was in";
  const Subscriber ear(port(), watcher_.at("user"), watcher_.at("password"));
  EXPECT_TRUE(comes_true([&] {
    const Json heard = ear.json("room");
    return heard.is_object() && heard.at("title") == "Red";
  }));
  EXPECT_EQ(ear.json("room").at("chairs"), Json({"p03"}));
}

TEST_F(Rights, WhatIsNoRoomIsPutRight) {
  ASSERT_TRUE(say(port(), chair_, kBase + "room", "rubbish"));
  const Subscriber ear(port(), watcher_.at("user"), watcher_.at("password"));
  EXPECT_TRUE(comes_true([&] {
    const auto heard = ear.newest("room");
    return heard && heard->payload != "rubbish" && ear.json("room").at("title") == "Blue room";
  }));
}

TEST_F(Rights, OthersAreNotLetIn) {
  for (const auto& [user, password] :
       std::vector<std::pair<std::string, std::string>>{{"studio.p01", "guess"},
                                                        {"studio.p01", bo_.at("password")},
                                                        {"studio.p09", ana_.at("password")},
                                                        {"studio.service", ""},
                                                        {"", ""}}) {
    EXPECT_FALSE(say(port(), {{"user", user}, {"password", password}}, kBase + "p/p01/chat", "x")) << user;
  }
}

// No account of a room hears another room: here one more does, at a broker with the same rules.
TEST(MeetingAccounts, AnotherRoomIsNotReached) {
  const MeetingAddress meeting{"home", "studio"};
  const std::vector<BrokerAccount> members = {participant_account(meeting, "key", "p01", /*chair=*/true),
                                              participant_account(meeting, "key", "p02", /*chair=*/false),
                                              watcher_account(meeting, "key"), service_account(meeting)};
  const BrokerAccount all{"all", "hears all", {"r/#"}, {"r/#"}};
  std::vector<BrokerAccount> accounts = members;
  accounts.push_back(all);
  BrokerPlace place;
  place.program = TELEMIME_MOSQUITTO;
  place.port = 0;
  place.web_port = 0;
  const HostedBroker broker(place, meeting, accounts, [](const std::string&) {});
  const Subscriber ear(broker.port(), all.user, all.password, "r/");
  ASSERT_TRUE(comes_true([&] { return ear.listens(); }));
  const auto from = [&](const BrokerAccount& account, const std::string& topic) {
    // The receipt says nothing: MQTT 3.1.1 has no word for a refusal.
    EXPECT_TRUE(
        say(broker.port(), {{"user", account.user}, {"password", account.password}}, topic, account.user));
  };
  const std::vector<std::string> elsewhere = {"r/home/other/p/p02/chat",   "r/home/other/p/p01/chat",
                                              "r/home/other/room",         "r/else/studio/p/p02/chat",
                                              "r/home/studio2/p/p02/chat", "r/studio/p/p02/chat",
                                              "r/home/../other/room",      "r/home//studio/p/p02/chat",
                                              "r/home/p/p02/chat",         "r/home/Studio/room"};
  for (const BrokerAccount& account : members) {
    for (const std::string& topic : elsewhere) {
      from(account, topic);
    }
  }
  from(members[1], kBase + "p/p02/chat");
  from(all, "r/home/other/room");
  // The broker delivers in order: behind this one nothing more comes.
  ASSERT_TRUE(comes_true([&] { return ear.newest("home/other/room").has_value(); }));
  std::vector<std::string> heard;
  for (const Subscriber::Heard& one : ear.all()) {
    heard.push_back(one.topic + " by " + one.payload);
  }
  EXPECT_EQ(heard,
            (std::vector<std::string>{"home/studio/p/p02/chat by studio.p02", "home/other/room by all"}));
}

TEST(MeetingAccounts, WhoWasFreedCannotSpeakAsAnybody) {
  OpenMeeting meeting([](HostOptions& plan) {
    plan.most = 1;
    plan.keeps_seat = 0.0;
  });
  const std::uint16_t port = meeting.host().mqtt_port();
  const Json first = meeting.newcomer();
  EXPECT_TRUE(say(port, first, kBase + "p/p01/state", "left behind"));
  const Json second = meeting.newcomer();
  EXPECT_EQ(second.at("participant"), "p02");
  EXPECT_FALSE(say(port, first, kBase + "p/p02/chat", "x")) << "the account is gone";
  EXPECT_TRUE(say(port, second, kBase + "p/p02/chat", "hello"));
  const Subscriber ear(port, second.at("user"), second.at("password"));
  EXPECT_TRUE(comes_true([&] { return ear.newest("p/p02/chat").has_value(); }));
  EXPECT_TRUE(comes_true([&] {
    const Subscriber late(port, second.at("user"), second.at("password"));
    comes_true([&] { return late.newest("room").has_value() && late.newest("p/p02/chat").has_value(); });
    return !late.newest("p/p01/state");
  })) << "and what was kept of them";
  const Json back = meeting.enter({{"return", first.at("return")}});
  EXPECT_EQ(back.at("participant"), "p01") << "who comes back is who they were";
  EXPECT_TRUE(say(port, back, kBase + "p/p01/chat", "x"));
  EXPECT_FALSE(say(port, second, kBase + "p/p01/chat", "x"));
}

}  // namespace
}  // namespace telemime::meeting::test_support
