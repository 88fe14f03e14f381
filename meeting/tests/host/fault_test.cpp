// SPDX-License-Identifier: Apache-2.0
// An open room when something goes wrong, and when it is closed.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "broker/subscriber.h"
#include "meeting/hosting/secrets.h"
#include "open_meeting.h"
#include "telemime/core/errors.h"

namespace telemime::meeting::test_support {
namespace {

using Json = nlohmann::json;

const std::string kChat = "r/home/studio/p/p01/chat";

std::string refusal(const OpenMeeting::Change& change) {
  try {
    const OpenMeeting meeting(change);
  } catch (const Error& e) {
    return e.what();
  }
  return "nothing was refused";
}

bool has(const std::string& text, const std::string& words) {
  return text.find(words) != std::string::npos;
}

/// Of /proc/net/tcp and tcp6: the local addresses that something listens at with this port.
std::vector<std::string> listeners(std::uint16_t port) {
  std::array<char, 8> hex{};
  std::snprintf(hex.data(), hex.size(), ":%04X", port);
  std::vector<std::string> found;
  for (const char* const table : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream in(table);
    std::string number;
    std::string local;
    std::string remote;
    std::string state;
    for (std::string line; std::getline(in, line);) {
      std::istringstream(line) >> number >> local >> remote >> state;
      if (local.ends_with(hex.data()) && state == "0A") {
        found.push_back(local.substr(0, local.find(':')));
      }
    }
  }
  return found;
}

TEST(MeetingFaults, ABrokerThatDiesIsStartedAnewWithAllThatItKnew) {
  OpenMeeting meeting;
  const std::uint16_t port = meeting.host().mqtt_port();
  const Json ana = meeting.newcomer();
  ASSERT_TRUE(say(port, ana, kChat, "before"));
  for (int time = 0; time < 2; ++time) {
    const pid_t before = meeting.host().broker();
    ASSERT_EQ(::kill(before, SIGKILL), 0);
    ASSERT_TRUE(comes_true([&] { return meeting.host().broker() > 0 && meeting.host().broker() != before; }));
    const Json late = meeting.newcomer();  // waits until the new one lets people in
    EXPECT_EQ(meeting.host().mqtt_port(), port);
    EXPECT_TRUE(say(port, ana, kChat, "after"));
    const Subscriber ear(port, late.at("user"), late.at("password"));
    EXPECT_TRUE(comes_true([&] { return ear.newest("room").has_value(); }));
    EXPECT_EQ(ear.json("room").at("title"), "Blue room");
  }
  EXPECT_TRUE(has(meeting.heard(), "the broker has ended (signal 9); it is started anew")) << meeting.heard();
  EXPECT_FALSE(has(meeting.heard(), ana.at("password")));
}

TEST(MeetingFaults, ItListensWhereItWasAskedToAlone) {
  OpenMeeting meeting;
  EXPECT_EQ(listeners(meeting.host().mqtt_port()), std::vector<std::string>{"0100007F"});
  EXPECT_EQ(listeners(meeting.host().web_port()), std::vector<std::string>{"0100007F"});
  for (const std::string& address : listeners(meeting.host().port())) {
    EXPECT_TRUE(address == "0100007F" || address == "00000000000000000000000001000000") << address;
  }
}

TEST(MeetingFaults, NothingStaysBehind) {
  const auto folders = [] {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::temp_directory_path())) {
      names.insert(entry.path().string());
    }
    return names;
  };
  OpenMeeting meeting;
  const pid_t broker = meeting.host().broker();
  const std::uint16_t port = meeting.host().mqtt_port();
  std::string own;  // the folder of this broker, by what its program was started with
  {
    std::ifstream in("/proc/" + std::to_string(broker) + "/cmdline");
    const std::string words{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
    own = std::filesystem::path(words.substr(words.find("-c") + 3).c_str()).parent_path();
  }
  ASSERT_TRUE(folders().contains(own)) << own;
  struct stat about {};
  ASSERT_EQ(::stat(own.c_str(), &about), 0);
  EXPECT_EQ(about.st_mode & 0777U, 0700U);
  meeting.close();
  EXPECT_NE(::kill(broker, 0), 0);
  EXPECT_TRUE(listeners(port).empty());
  EXPECT_FALSE(std::filesystem::exists(own));
}

TEST(MeetingFaults, LinksAndSeatsOutliveTheProgram) {
  OpenMeeting meeting;
  const std::string link = meeting.speak();
  const Json ana = meeting.newcomer();
  meeting.close();
  meeting.open();
  EXPECT_EQ(meeting.speak(), link);
  EXPECT_FALSE(say(meeting.host().mqtt_port(), ana, kChat, "x")) << "who does not enter has no account";
  EXPECT_EQ(meeting.newcomer().at("participant"), "p02") << "nobody gets the id of another";
  EXPECT_EQ(meeting.enter({{"return", ana.at("return")}}).at("participant"), "p01");
  EXPECT_TRUE(say(meeting.host().mqtt_port(), ana, kChat, "x"));
  meeting.close();
  meeting.open([](HostOptions& plan) { plan.new_links = true; });
  EXPECT_NE(meeting.speak(), link);
  EXPECT_EQ(meeting.ask(Json{{"v", 1}, {"invite", link}}.dump()).status, 403);
  EXPECT_EQ(meeting.ask(Json{{"v", 1}, {"return", ana.at("return")}}.dump()).status, 403);
}

TEST(MeetingFaults, WhatCannotBeUsedIsToldInWords) {
  EXPECT_TRUE(has(refusal([](HostOptions& plan) { plan.broker.program = "/nothing/here"; }), "--mosquitto"));
  EXPECT_TRUE(has(refusal([](HostOptions& plan) { plan.broker.program = "/bin/false"; }),
                  "the broker does not start: code 1"));
  EXPECT_TRUE(has(refusal([](HostOptions& plan) { plan.name = "A B"; }), "A B"));
  EXPECT_TRUE(has(refusal([](HostOptions& plan) { plan.seats = 0; }), "seats"));
  EXPECT_TRUE(has(refusal([](HostOptions& plan) { plan.address = "there"; }), "'there'"));
  EXPECT_TRUE(
      has(refusal([](HostOptions& plan) { plan.address = "203.0.113.7"; }), "no address 203.0.113.7"));
  EXPECT_TRUE(has(refusal([](HostOptions& plan) { plan.certificate = "x"; }), "--key"));
  EXPECT_TRUE(has(refusal([](HostOptions& plan) { plan.certificate = plan.key = "/nothing/here"; }),
                  "/nothing/here"));
  EXPECT_TRUE(has(refusal([](HostOptions& plan) {
                    SecretsFile(plan.secrets).load();
                    std::filesystem::permissions(plan.secrets, std::filesystem::perms{0644});
                  }),
                  "others of this computer may read it"));
}

TEST(MeetingFaults, ATakenPortIsToldOrAnotherOneChosen) {
  OpenMeeting first;
  const std::uint16_t taken = first.host().mqtt_port();
  const std::string number = std::to_string(taken);
  EXPECT_TRUE(
      has(refusal([&](HostOptions& plan) { plan.broker.port = taken; }), "port " + number + " is taken"));
  EXPECT_TRUE(has(refusal([&](HostOptions& plan) { plan.broker.web_port = taken; }), "--ws-port"));
  EXPECT_TRUE(has(refusal([&](HostOptions& plan) { plan.port = first.host().port(); }), "is taken"));
  // The usual ones may be free or taken on this computer: both are fine, and two rooms have no port in
  // common.
  const auto usual = [](HostOptions& plan) {
    plan.broker.port.reset();
    plan.broker.web_port.reset();
  };
  OpenMeeting second(usual);
  OpenMeeting third(usual);
  EXPECT_NE(second.host().mqtt_port(), third.host().mqtt_port());
  EXPECT_NE(second.host().web_port(), third.host().web_port());
  EXPECT_TRUE(has(third.heard(), "port 1883 is taken by another program: MQTT uses ")) << third.heard();
}

}  // namespace
}  // namespace telemime::meeting::test_support
