// SPDX-License-Identifier: Apache-2.0
// `telemime meeting` as a user runs it: its output, and what it leaves behind.
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdlib>
#include <filesystem>

#include "e2e/run_program.h"
#include "meeting/protocol/testing.h"
#include "meeting/transport/login.h"
#include "open_meeting.h"

namespace telemime::meeting::test_support {
namespace {

namespace fs = std::filesystem;

/// The running children of a process.
std::vector<pid_t> children_of(pid_t parent) {
  std::vector<pid_t> found;
  for (const auto& login : fs::directory_iterator("/proc")) {
    const std::string name = login.path().filename();
    if (name.find_first_not_of("0123456789") == std::string::npos) {
      const std::string status = content_of(login.path() / "stat");
      std::istringstream rest(status.substr(std::min(status.rfind(')') + 1, status.size())));
      char state = 0;
      pid_t of = 0;
      if (rest >> state >> of && of == parent && state != 'Z') {
        found.push_back(std::stoi(name));
      }
    }
  }
  return found;
}

class MeetingCommand : public ::testing::Test {
 protected:
  MeetingCommand() { ::setenv("XDG_STATE_HOME", folder_.path().c_str(), 1); }
  ~MeetingCommand() override { ::unsetenv("XDG_STATE_HOME"); }
  std::vector<std::string> meeting(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all = {"meeting",   "--port", "0",           "--mqtt-port",     "0",
                                    "--ws-port", "0",      "--mosquitto", TELEMIME_MOSQUITTO};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// The rest of the output line that begins with `start`.
  static std::string line(const std::string& text, const std::string& start) {
    const std::size_t at = ("\n" + text).find("\n" + start);
    return at == std::string::npos ? ""
                                   : text.substr(at + start.size(), text.find('\n', at) - at - start.size());
  }
  e2e::Folder folder_;
};

TEST_F(MeetingCommand, PrintsItsLinks) {
  const e2e::Ended ended = e2e::run(meeting({"--title", "Blue room", "--seconds", "0.2"}));
  EXPECT_EQ(ended.code, 0) << ended.words;
  EXPECT_EQ(ended.words, "");
  EXPECT_TRUE(contains(ended.output, "Meeting \"Blue room\" is open: http://localhost:")) << ended.output;
  for (const char* const what : {"to speak: ", "to watch: ", "to chair: "}) {
    EXPECT_TRUE(is_meeting_link(line(ended.output, what))) << ended.output;
  }
  const e2e::Ended again = e2e::run(meeting({"--seconds", "0.2"}));
  const auto invite = [](const e2e::Ended& run) {
    return OpenMeeting::invite_of(line(run.output, "to speak: "));
  };
  EXPECT_EQ(invite(again), invite(ended)) << "links stay the same";
  EXPECT_NE(invite(e2e::run(meeting({"--seconds", "0.2", "--new-links"}))), invite(ended));
  EXPECT_NE(invite(e2e::run(meeting({"--seconds", "0.2", "--name", "other"}))), invite(ended));
}

TEST_F(MeetingCommand, LeavesNoBrokerBehind) {
  for (const int number : {SIGTERM, SIGINT, SIGHUP, SIGKILL}) {
    e2e::Program program(meeting());
    ASSERT_TRUE(comes_true([&] { return contains(program.output(), "MQTT at port"); })) << program.words();
    const std::vector<pid_t> brokers = children_of(program.process());
    ASSERT_EQ(brokers.size(), 1U);
    const std::string command = content_of("/proc/" + std::to_string(brokers[0]) + "/cmdline");
    const fs::path own = fs::path(command.substr(command.find("-c") + 3).c_str()).parent_path();
    EXPECT_TRUE(fs::exists(own));
    program.signal(number);
    if (number == SIGHUP) {
      program.signal(number);  // closing a terminal may send it twice
    }
    const e2e::Ended ended = program.wait();
    EXPECT_EQ(ended.code, number == SIGKILL ? -1 : 0) << ended.words;
    EXPECT_TRUE(comes_true([&] {
      return children_of(::getpid()).empty() && !fs::exists("/proc/" + std::to_string(brokers[0]) + "/exe");
    }));
    EXPECT_TRUE(number == SIGKILL || !fs::exists(own)) << own;
    if (number == SIGKILL) {
      fs::remove_all(own);
    }
  }
}

TEST_F(MeetingCommand, PrintsNoSecretsButItsLinks) {
  e2e::Program program(meeting());
  ASSERT_TRUE(comes_true([&] { return contains(program.output(), "MQTT at port"); })) << program.words();
  LinkLogin login;
  login.link = line(program.output(), "to speak: ");
  const Credentials key = log_in_by_link(login);
  const std::vector<pid_t> brokers = children_of(program.process());
  ASSERT_EQ(brokers.size(), 1U);
  std::vector<std::string> secrets = {key.password, key.rejoin};
  for (const char* const what : {"to speak: ", "to watch: ", "to chair: "}) {
    secrets.push_back(OpenMeeting::invite_of(line(program.output(), what)));
  }
  std::string seen;
  for (const pid_t process : {program.process(), brokers[0]}) {
    seen += content_of("/proc/" + std::to_string(process) + "/cmdline");
    seen += content_of("/proc/" + std::to_string(process) + "/environ");
  }
  const std::string command = content_of("/proc/" + std::to_string(brokers[0]) + "/cmdline");
  const fs::path own = fs::path(command.substr(command.find("-c") + 3).c_str()).parent_path();
  for (const auto& entry : fs::directory_iterator(own)) {
    seen += fs::is_regular_file(entry.path()) ? content_of(entry.path()) : "";
  }
  ASSERT_EQ(::kill(brokers[0], SIGKILL), 0);
  ASSERT_TRUE(comes_true([&] { return contains(program.words(), "restarting it"); }));
  ASSERT_TRUE(contains(seen, "studio") || contains(seen, key.user)) << "the files of the broker were read";
  for (const std::string& secret : secrets) {
    EXPECT_FALSE(contains(seen + program.words(), secret));
  }
  EXPECT_FALSE(contains(program.output(), key.password));
  EXPECT_FALSE(contains(program.output(), key.rejoin));
}

TEST_F(MeetingCommand, FailuresHaveTheirExitCode) {
  EXPECT_EQ(e2e::run(meeting({"--name", "A B"})).code, 2);
  EXPECT_EQ(e2e::run(meeting({"--address", "there"})).code, 2);
  EXPECT_EQ(e2e::run(meeting({"--certificate", "/nothing/here", "--key", "/nothing/here"})).code, 2);
  EXPECT_EQ(e2e::run(meeting({"--avatars", "/nothing/here"})).code, 2);
  EXPECT_EQ(e2e::run({"meeting", "--mosquitto", "/nothing/here"}).code, 2);
  const e2e::Ended twice = e2e::run({"meeting", "--port", "0", "--mqtt-port", "29001", "--ws-port", "29001",
                                     "--mosquitto", TELEMIME_MOSQUITTO});
  EXPECT_EQ(twice.code, 2);
  EXPECT_TRUE(contains(twice.words, "port 29001 is requested twice")) << twice.words;
  const e2e::Ended page = e2e::run({"meeting", "--port", "29002", "--mqtt-port", "0", "--ws-port", "29002",
                                    "--mosquitto", TELEMIME_MOSQUITTO});
  EXPECT_EQ(page.code, 2) << "the page's port: " << page.words;
  const WebServer other(any_port(), {});
  const e2e::Ended taken = e2e::run(
      {"meeting", "--port", std::to_string(other.port()), "--mqtt-port", "0", "--ws-port", "0", "--quiet"});
  EXPECT_EQ(taken.code, 5);
  EXPECT_TRUE(contains(taken.words, std::to_string(other.port()))) << taken.words;
}

}  // namespace
}  // namespace telemime::meeting::test_support
