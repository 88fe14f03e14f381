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

#include "meeting/hosting/room_secrets.h"
#include "rooms/ear.h"
#include "telemime/core/errors.h"
#include "visitor.h"

namespace telemime::testing_rooms {
namespace {

using Json = nlohmann::json;

const std::string kChat = "r/home/studio/p/p01/chat";

std::string refusal(const OpenRoom::Change& change) {
  try {
    const OpenRoom room(change);
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

TEST(RoomFaults, ABrokerThatDiesIsStartedAnewWithAllThatItKnew) {
  OpenRoom room;
  const std::uint16_t port = room.host().mqtt_port();
  const Json ana = room.newcomer();
  ASSERT_TRUE(say(port, ana, kChat, "before"));
  for (int time = 0; time < 2; ++time) {
    const pid_t before = room.host().broker();
    ASSERT_EQ(::kill(before, SIGKILL), 0);
    ASSERT_TRUE(comes_true([&] { return room.host().broker() > 0 && room.host().broker() != before; }));
    const Json late = room.newcomer();  // waits until the new one lets people in
    EXPECT_EQ(room.host().mqtt_port(), port);
    EXPECT_TRUE(say(port, ana, kChat, "after"));
    const Ear ear(port, late.at("user"), late.at("password"));
    EXPECT_TRUE(comes_true([&] { return ear.newest("room").has_value(); }));
    EXPECT_EQ(ear.json("room").at("title"), "Blue room");
  }
  EXPECT_TRUE(has(room.heard(), "the broker has ended (signal 9); it is started anew")) << room.heard();
  EXPECT_FALSE(has(room.heard(), ana.at("password")));
}

TEST(RoomFaults, ItListensWhereItWasAskedToAlone) {
  OpenRoom room;
  EXPECT_EQ(listeners(room.host().mqtt_port()), std::vector<std::string>{"0100007F"});
  EXPECT_EQ(listeners(room.host().web_port()), std::vector<std::string>{"0100007F"});
  for (const std::string& address : listeners(room.host().port())) {
    EXPECT_TRUE(address == "0100007F" || address == "00000000000000000000000001000000") << address;
  }
}

TEST(RoomFaults, NothingStaysBehind) {
  const auto folders = [] {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::temp_directory_path())) {
      names.insert(entry.path().string());
    }
    return names;
  };
  OpenRoom room;
  const pid_t broker = room.host().broker();
  const std::uint16_t port = room.host().mqtt_port();
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
  room.close();
  EXPECT_NE(::kill(broker, 0), 0);
  EXPECT_TRUE(listeners(port).empty());
  EXPECT_FALSE(std::filesystem::exists(own));
}

TEST(RoomFaults, LinksAndSeatsOutliveTheProgram) {
  OpenRoom room;
  const std::string link = room.speak();
  const Json ana = room.newcomer();
  room.close();
  room.open();
  EXPECT_EQ(room.speak(), link);
  EXPECT_FALSE(say(room.host().mqtt_port(), ana, kChat, "x")) << "who does not enter has no account";
  EXPECT_EQ(room.newcomer().at("participant"), "p02") << "nobody gets the id of another";
  EXPECT_EQ(room.enter({{"return", ana.at("return")}}).at("participant"), "p01");
  EXPECT_TRUE(say(room.host().mqtt_port(), ana, kChat, "x"));
  room.close();
  room.open([](RoomPlan& plan) { plan.new_links = true; });
  EXPECT_NE(room.speak(), link);
  EXPECT_EQ(room.ask(Json{{"v", 1}, {"invite", link}}.dump()).status, 403);
  EXPECT_EQ(room.ask(Json{{"v", 1}, {"return", ana.at("return")}}.dump()).status, 403);
}

TEST(RoomFaults, WhatCannotBeUsedIsToldInWords) {
  EXPECT_TRUE(has(refusal([](RoomPlan& plan) { plan.broker.program = "/nothing/here"; }), "--mosquitto"));
  EXPECT_TRUE(has(refusal([](RoomPlan& plan) { plan.broker.program = "/bin/false"; }),
                  "the broker does not start: code 1"));
  EXPECT_TRUE(has(refusal([](RoomPlan& plan) { plan.name = "A B"; }), "A B"));
  EXPECT_TRUE(has(refusal([](RoomPlan& plan) { plan.seats = 0; }), "seats"));
  EXPECT_TRUE(has(refusal([](RoomPlan& plan) { plan.address = "there"; }), "'there'"));
  EXPECT_TRUE(has(refusal([](RoomPlan& plan) { plan.address = "203.0.113.7"; }), "no address 203.0.113.7"));
  EXPECT_TRUE(has(refusal([](RoomPlan& plan) { plan.certificate = "x"; }), "--key"));
  EXPECT_TRUE(
      has(refusal([](RoomPlan& plan) { plan.certificate = plan.key = "/nothing/here"; }), "/nothing/here"));
  EXPECT_TRUE(has(refusal([](RoomPlan& plan) {
                    SecretsFile(plan.secrets).load();
                    std::filesystem::permissions(plan.secrets, std::filesystem::perms{0644});
                  }),
                  "others of this computer may read it"));
}

TEST(RoomFaults, ATakenPortIsToldOrAnotherOneChosen) {
  OpenRoom first;
  const std::uint16_t taken = first.host().mqtt_port();
  const std::string number = std::to_string(taken);
  EXPECT_TRUE(
      has(refusal([&](RoomPlan& plan) { plan.broker.port = taken; }), "port " + number + " is taken"));
  EXPECT_TRUE(has(refusal([&](RoomPlan& plan) { plan.broker.web_port = taken; }), "--ws-port"));
  EXPECT_TRUE(has(refusal([&](RoomPlan& plan) { plan.port = first.host().port(); }), "is taken"));
  // The usual ones may be free or taken on this computer: both are fine, and two rooms have no port in
  // common.
  const auto usual = [](RoomPlan& plan) {
    plan.broker.port.reset();
    plan.broker.web_port.reset();
  };
  OpenRoom second(usual);
  OpenRoom third(usual);
  EXPECT_NE(second.host().mqtt_port(), third.host().mqtt_port());
  EXPECT_NE(second.host().web_port(), third.host().web_port());
  EXPECT_TRUE(has(third.heard(), "port 1883 is taken by another program: MQTT uses ")) << third.heard();
}

}  // namespace
}  // namespace telemime::testing_rooms
