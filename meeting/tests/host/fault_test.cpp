// SPDX-License-Identifier: Apache-2.0
// An open meeting when something fails, and when it is closed.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "checks.h"
#include "meeting/hosting/secrets.h"
#include "meeting/protocol/testing.h"
#include "open_meeting.h"

namespace telemime::meeting::test_support {
namespace {

using Json = nlohmann::json;

const std::string kChat = "r/home/studio/p/p01/chat";

std::string refusal(const OpenMeeting::Change& change) {
  return error_of([&] { const OpenMeeting meeting(change); });
}

/// The local addresses with a listener at this port, from /proc/net/tcp and tcp6.
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

TEST(MeetingFaults, DeadBrokerIsRestartedWithItsAccounts) {
  OpenMeeting meeting;
  const std::uint16_t port = meeting.host().mqtt_port();
  const Json ana = meeting.join();
  ASSERT_TRUE(publish(port, ana, kChat, "before"));
  for (int time = 0; time < 2; ++time) {
    const pid_t before = meeting.host().broker();
    ASSERT_EQ(::kill(before, SIGKILL), 0);
    ASSERT_TRUE(comes_true([&] { return meeting.host().broker() > 0 && meeting.host().broker() != before; }));
    const Json late = meeting.join();  // waits until the new broker accepts clients
    EXPECT_EQ(meeting.host().mqtt_port(), port);
    EXPECT_TRUE(publish(port, ana, kChat, "after"));
    const Subscriber subscriber(port, late.at("user"), late.at("password"));
    EXPECT_TRUE(comes_true([&] { return subscriber.newest("room").has_value(); }));
    EXPECT_EQ(subscriber.json("room").at("title"), "Blue room");
  }
  EXPECT_TRUE(contains(meeting.reports(), "the broker ended (signal 9); restarting it")) << meeting.reports();
  EXPECT_FALSE(contains(meeting.reports(), ana.at("password")));
}

// Another program may take a port between the choice and the broker's start.
TEST(MeetingFaults, PortTakenMeanwhileIsChosenAgain) {
  for (const std::string words :
       {"Address already in use", "Unable to create websockets listener on port 1."}) {
    const ScratchFolder folder;
    const std::filesystem::path program = folder.path() / "mosquitto";
    std::ofstream(program) << "#!/bin/sh\nif mkdir '" << folder.file("tried")
                           << "' 2> /dev/null; then echo 'Error: " << words
                           << "' >&2; exit 1; fi\nexec " TELEMIME_MOSQUITTO " \"$@\"\n";
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    OpenMeeting meeting([&](HostOptions& options) { options.broker.program = program.string(); });
    EXPECT_TRUE(publish(meeting.host().mqtt_port(), meeting.join(), kChat, "here")) << words;
  }
}

TEST(MeetingFaults, ListensAtTheRequestedAddressOnly) {
  OpenMeeting meeting;
  EXPECT_EQ(listeners(meeting.host().mqtt_port()), std::vector<std::string>{"0100007F"});
  EXPECT_EQ(listeners(meeting.host().web_port()), std::vector<std::string>{"0100007F"});
  for (const std::string& address : listeners(meeting.host().port())) {
    EXPECT_TRUE(address == "0100007F" || address == "00000000000000000000000001000000") << address;
  }
}

TEST(MeetingFaults, ClosingLeavesNothingBehind) {
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
  std::string own;  // the folder of this broker, from its command line
  {
    const std::string text = content_of("/proc/" + std::to_string(broker) + "/cmdline");
    own = std::filesystem::path(text.substr(text.find("-c") + 3).c_str()).parent_path();
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
  const Json ana = meeting.join();
  meeting.close();
  meeting.open();
  EXPECT_EQ(meeting.speak(), link);
  EXPECT_FALSE(publish(meeting.host().mqtt_port(), ana, kChat, "x")) << "without a login there is no account";
  EXPECT_EQ(meeting.join().at("participant"), "p02") << "ids are not reused";
  EXPECT_EQ(meeting.log_in({{"return", ana.at("return")}}).at("participant"), "p01");
  EXPECT_TRUE(publish(meeting.host().mqtt_port(), ana, kChat, "x"));
  meeting.close();
  meeting.open([](HostOptions& options) { options.new_links = true; });
  EXPECT_NE(meeting.speak(), link);
  EXPECT_EQ(meeting.post(Json{{"v", 1}, {"invite", link}}.dump()).status, 403);
  EXPECT_EQ(meeting.post(Json{{"v", 1}, {"return", ana.at("return")}}.dump()).status, 403);
}

TEST(MeetingFaults, MembersStayWhereNewcomersCannotBeStored) {
  OpenMeeting meeting;
  const Json ana = meeting.join();
  const std::filesystem::path folder = std::filesystem::path(meeting.secrets()).parent_path();
  const std::filesystem::path elsewhere = folder.string() + ".away";
  std::filesystem::rename(folder, elsewhere);  // like a full disk: no file can be written there
  const auto newcomer = [&] {
    return meeting.post(Json{{"v", 1}, {"invite", meeting.speak()}}.dump()).status;
  };
  EXPECT_EQ(newcomer(), 503);
  EXPECT_EQ(meeting.log_in({{"return", ana.at("return")}}).at("participant"), "p01") << "reloads the page";
  EXPECT_TRUE(publish(meeting.host().mqtt_port(), ana, kChat, "still here"));
  EXPECT_EQ(
      meeting.post(Json{{"v", 1}, {"invite", meeting.chair()}, {"return", ana.at("return")}}.dump()).status,
      503)
      << "a chair's rights are new to the broker";
  EXPECT_EQ(meeting.log_in({{"return", ana.at("return")}}).at("participant"), "p01") << "as before";
  std::filesystem::rename(elsewhere, folder);
  EXPECT_EQ(newcomer(), 200);
}

TEST(MeetingFaults, InvalidOptionsAreReported) {
  EXPECT_TRUE(contains(refusal([](HostOptions& options) { options.broker.program = "/nothing/here"; }),
                       "--mosquitto"));
  EXPECT_TRUE(contains(refusal([](HostOptions& options) { options.broker.program = "/bin/false"; }),
                       "the broker does not start: code 1"));
  EXPECT_TRUE(contains(refusal([](HostOptions& options) { options.name = "A B"; }), "A B"));
  EXPECT_TRUE(contains(refusal([](HostOptions& options) { options.seats = 0; }), "seats"));
  EXPECT_TRUE(contains(refusal([](HostOptions& options) { options.address = "there"; }), "'there'"));
  EXPECT_TRUE(contains(refusal([](HostOptions& options) { options.address = "203.0.113.7"; }),
                       "does not have the address 203.0.113.7"));
  EXPECT_TRUE(contains(refusal([](HostOptions& options) { options.certificate = "x"; }), "--key"));
  EXPECT_TRUE(
      contains(refusal([](HostOptions& options) { options.certificate = options.key = "/nothing/here"; }),
               "/nothing/here"));
  EXPECT_TRUE(contains(refusal([](HostOptions& options) {
                         SecretsFile(options.secrets).load();
                         std::filesystem::permissions(options.secrets, std::filesystem::perms{0644});
                       }),
                       "other users of this computer can read it"));
}

TEST(MeetingFaults, TakenPortIsReportedOrReplaced) {
  OpenMeeting first;
  const std::uint16_t taken = first.host().mqtt_port();
  const std::string number = std::to_string(taken);
  EXPECT_TRUE(contains(refusal([&](HostOptions& options) { options.broker.port = taken; }),
                       "port " + number + " is taken"));
  EXPECT_TRUE(contains(refusal([&](HostOptions& options) { options.broker.web_port = taken; }), "--ws-port"));
  EXPECT_TRUE(
      contains(refusal([&](HostOptions& options) { options.port = first.host().port(); }), "is taken"));
  // The usual ports may be free or taken on this computer; in any case two meetings have different ones.
  const auto usual = [](HostOptions& options) {
    options.broker.port.reset();
    options.broker.web_port.reset();
  };
  OpenMeeting second(usual);
  OpenMeeting third(usual);
  EXPECT_NE(second.host().mqtt_port(), third.host().mqtt_port());
  EXPECT_NE(second.host().web_port(), third.host().web_port());
  EXPECT_TRUE(contains(third.reports(), "port 1883 is taken by another program: MQTT uses "))
      << third.reports();
}

}  // namespace
}  // namespace telemime::meeting::test_support
