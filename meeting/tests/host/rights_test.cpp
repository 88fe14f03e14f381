// SPDX-License-Identifier: Apache-2.0
// The rights of accounts at the broker of an open meeting.
#include <gtest/gtest.h>

#include "checks.h"
#include "meeting/hosting/hosted_broker.h"
#include "open_meeting.h"

namespace telemime::meeting::test_support {
namespace {

using Json = nlohmann::json;

const std::string kBase = "r/home/studio/";

class Rights : public ::testing::Test {
 protected:
  /// Whether the others receive what the account publishes.
  bool reaches(const Json& account, const std::string& topic, const std::string& payload = "x") {
    const Subscriber subscriber(port(), watcher_.at("user"), watcher_.at("password"));
    EXPECT_TRUE(comes_true([&] { return subscriber.newest("room").has_value(); }));
    publish(port(), account, kBase + topic, payload);
    // The broker delivers in order: nothing else can follow this message.
    EXPECT_TRUE(publish(port(), ana_, kBase + "p/p01/presence", "end"));
    EXPECT_TRUE(comes_true([&] {
      const auto end = subscriber.newest("p/p01/presence");
      return end && end->payload == "end" && !end->retained;
    }));
    const auto reports = subscriber.newest(topic);
    const bool reached = reports && reports->payload == payload;
    publish(port(), ana_, kBase + "p/p01/presence", "");
    return reached;
  }
  std::uint16_t port() { return meeting_.host().mqtt_port(); }

  OpenMeeting meeting_;
  Json ana_ = meeting_.join();
  Json bo_ = meeting_.join();
  Json chair_ = meeting_.log_in({{"invite", meeting_.chair()}});
  Json watcher_ = meeting_.log_in({{"invite", meeting_.watch()}});
};

TEST_F(Rights, ParticipantsPublishAsThemselvesOnly) {
  for (const char* const what : {"chat", "state", "pose", "board/0", "board/63"}) {
    EXPECT_TRUE(reaches(bo_, std::string("p/p02/") + what)) << what;
  }
  for (const char* const what : {"p/p01/chat", "p/p01/pose", "p/p03/chat", "p/p02/else", "p/p02/board/64",
                                 "p/p02/board/00", "p/p2/chat", "p/p02/chat/more", "room", "else"}) {
    EXPECT_FALSE(reaches(bo_, what)) << what;
  }
}

TEST_F(Rights, WatchersPublishNothing) {
  for (const char* const what : {"p/p01/chat", "p/watch/chat", "room", "p/p01/pose"}) {
    EXPECT_FALSE(reaches(watcher_, what)) << what;
  }
}

TEST_F(Rights, ChairsChangeTheMeeting) {
  const std::string received = R"({"v":1,"title":"Red","seats":4,"epoch":2,"chairs":["p03"],"locked":true})";
  EXPECT_TRUE(reaches(chair_, "room", received));
  EXPECT_TRUE(comes_true([&] {
    return meeting_.post(Json{{"v", 1}, {"invite", meeting_.speak()}}.dump()).status == 423;
  })) << "locked for newcomers";
  EXPECT_EQ(meeting_.log_in({{"return", ana_.at("return")}}).at("participant"), "p01") << "not for members";
  const Subscriber subscriber(port(), watcher_.at("user"), watcher_.at("password"));
  EXPECT_TRUE(comes_true([&] {
    const Json reports = subscriber.json("room");
    return reports.is_object() && reports.at("title") == "Red";
  }));
  EXPECT_EQ(subscriber.json("room").at("chairs"), Json({"p03"}));
}

TEST_F(Rights, InvalidMeetingMessageIsReplaced) {
  ASSERT_TRUE(publish(port(), chair_, kBase + "room", "rubbish"));
  const Subscriber subscriber(port(), watcher_.at("user"), watcher_.at("password"));
  EXPECT_TRUE(comes_true([&] {
    const auto reports = subscriber.newest("room");
    return reports && reports->payload != "rubbish" && subscriber.json("room").at("title") == "Blue room";
  }));
}

TEST_F(Rights, OtherAccountsAreRejected) {
  for (const auto& [user, password] :
       std::vector<std::pair<std::string, std::string>>{{"studio.p01", "guess"},
                                                        {"studio.p01", bo_.at("password")},
                                                        {"studio.p09", ana_.at("password")},
                                                        {"studio.service", ""},
                                                        {"", ""}}) {
    EXPECT_FALSE(publish(port(), {{"user", user}, {"password", password}}, kBase + "p/p01/chat", "x"))
        << user;
  }
}

// Accounts cannot reach another meeting. An extra account observes this, at a broker with the same rules.
TEST(MeetingAccounts, AnotherMeetingIsNotReached) {
  const MeetingAddress meeting{"home", "studio"};
  const std::vector<BrokerAccount> members = {participant_account(meeting, "key", "p01", /*chair=*/true),
                                              participant_account(meeting, "key", "p02", /*chair=*/false),
                                              watcher_account(meeting, "key"), service_account(meeting)};
  const BrokerAccount all{"all", "hears all", {"r/#"}, {"r/#"}};
  std::vector<BrokerAccount> accounts = members;
  accounts.push_back(all);
  BrokerOptions options;
  options.program = TELEMIME_MOSQUITTO;
  options.port = 0;
  options.web_port = 0;
  const HostedBroker broker(options, meeting, accounts, [](const std::string&) {});
  const Subscriber subscriber(broker.port(), all.user, all.password, "r/");
  const auto from = [&](const BrokerAccount& account, const std::string& topic) {
    // The confirmation says nothing: MQTT 3.1.1 does not report a refusal.
    EXPECT_TRUE(publish(broker.port(), {{"user", account.user}, {"password", account.password}}, topic,
                        account.user));
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
  // The broker delivers in order: nothing else can follow this message.
  ASSERT_TRUE(comes_true([&] { return subscriber.newest("home/other/room").has_value(); }));
  std::vector<std::string> reports;
  for (const Subscriber::Received& one : subscriber.all()) {
    reports.push_back(one.topic + " by " + one.payload);
  }
  EXPECT_EQ(reports,
            (std::vector<std::string>{"home/studio/p/p02/chat by studio.p02", "home/other/room by all"}));
}

TEST(MeetingAccounts, RemovedParticipantCannotPublish) {
  OpenMeeting meeting([](HostOptions& options) {
    options.most = 1;
    options.keeps_seat = 0.0;
  });
  const std::uint16_t port = meeting.host().mqtt_port();
  const Json first = meeting.join();
  EXPECT_TRUE(publish(port, first, kBase + "p/p01/state", "left behind"));
  const Json second = meeting.join();
  EXPECT_EQ(second.at("participant"), "p02");
  EXPECT_FALSE(publish(port, first, kBase + "p/p02/chat", "x")) << "the account is gone";
  EXPECT_TRUE(publish(port, second, kBase + "p/p02/chat", "hello"));
  const Subscriber subscriber(port, second.at("user"), second.at("password"));
  EXPECT_TRUE(comes_true([&] { return subscriber.newest("p/p02/chat").has_value(); }));
  EXPECT_TRUE(comes_true([&] {
    const Subscriber late(port, second.at("user"), second.at("password"));
    comes_true([&] { return late.newest("room").has_value() && late.newest("p/p02/chat").has_value(); });
    return !late.newest("p/p01/state");
  })) << "and their retained messages";
  const Json back = meeting.log_in({{"return", first.at("return")}});
  EXPECT_EQ(back.at("participant"), "p01") << "rejoining gives the same participant";
  EXPECT_TRUE(publish(port, back, kBase + "p/p01/chat", "x"));
  EXPECT_FALSE(publish(port, second, kBase + "p/p01/chat", "x"));
}

}  // namespace
}  // namespace telemime::meeting::test_support
