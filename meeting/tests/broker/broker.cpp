// SPDX-License-Identifier: Apache-2.0
#include "broker.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "meeting/protocol/testing.h"
#include "telemime/streaming/testing_receivers.h"

namespace telemime::meeting::test_support {
namespace {

constexpr int kAttempts = 10;

bool accepts_connections(std::uint16_t port) {
  const testing_receivers::Fd fd(::socket(AF_INET, SOCK_STREAM, 0));
  const sockaddr_in where = testing_receivers::loopback(port);
  return ::connect(fd.get(), reinterpret_cast<const sockaddr*>(&where), sizeof(where)) == 0;
}

bool has_ended(pid_t process) {
  return ::waitpid(process, nullptr, WNOHANG) == process;
}

}  // namespace

pid_t start_program(const std::vector<std::string>& text, const std::string& output) {
  std::vector<char*> arguments;
  arguments.reserve(text.size() + 1);
  for (const std::string& word : text) {
    arguments.push_back(const_cast<char*>(word.c_str()));
  }
  arguments.push_back(nullptr);
  const pid_t process = ::fork();
  if (process == 0) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int file = ::open(output.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600);
    ::dup2(file, STDOUT_FILENO);
    ::dup2(file, STDERR_FILENO);
    ::execv(arguments[0], arguments.data());
    ::_exit(127);
  }
  return process;
}

void kill_process(pid_t& process) {
  if (process > 0) {
    ::kill(process, SIGKILL);
    ::waitpid(process, nullptr, 0);
    process = -1;
  }
}

void run(const std::vector<std::string>& text) {
  const ScratchFolder folder;
  const pid_t process = start_program(text, folder.file("output"));
  int status = -1;
  ASSERT_EQ(::waitpid(process, &status, 0), process);
  ASSERT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << text[0] << content_of(folder.file("output"));
}

Broker::Broker(const std::vector<Account>& accounts) {
  if (accounts.empty()) {
    choose_port("allow_anonymous true\n");
    return;
  }
  std::ofstream passwords(folder_.file("passwords"));
  std::ofstream rights(folder_.file("rights"));
  for (const Account& account : accounts) {
    passwords << account.user << ':' << account.password << '\n';
    rights << "user " << account.user << '\n' << account.rights << '\n';
  }
  passwords.close();
  rights.close();
  run({TELEMIME_MOSQUITTO_PASSWD, "-U", folder_.file("passwords")});
  choose_port("allow_anonymous false\npassword_file " + folder_.file("passwords") + "\nacl_file " +
              folder_.file("rights") + "\n");
}

Broker::Broker(Where where) {
  if (where == Where::everywhere) {
    address_.clear();
  }
  choose_port("allow_anonymous true\n");
}

Broker::Broker(const std::string& certificate, const std::string& key) {
  choose_port("allow_anonymous true\ncertfile " + certificate + "\nkeyfile " + key + "\n");
}

Broker::~Broker() {
  kill();
}

// Another program may take the port first: then try another one.
void Broker::choose_port(const std::string& more) {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    port_ = testing_receivers::free_port();
    std::ofstream(folder_.file("config")) << "listener " << port_ << address_ << '\n'
                                          << more << "persistence false\nlog_type all\n"
                                          << (::geteuid() == 0 ? "user root\n" : "");
    if (try_start()) {
      return;
    }
  }
  ADD_FAILURE() << "no broker could be started: " << log();
}

bool Broker::try_start() {
  process_ = start_program({TELEMIME_MOSQUITTO, "-c", folder_.file("config")}, folder_.file("log"));
  bool ended = false;
  const bool ready = testing_receivers::comes_true([&] {
    ended = has_ended(process_);
    return ended || accepts_connections(port_);
  });
  if (ended) {
    process_ = -1;
  }
  return ready && !ended;
}

void Broker::start() {
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (try_start()) {
      return;
    }
  }
  ADD_FAILURE() << "the broker does not start again: " << log();
}

void Broker::kill() {
  kill_process(process_);
}

std::string Broker::url(const std::string& user) const {
  return "mqtt://" + user + "127.0.0.1:" + std::to_string(port_) + "/home/studio";
}

std::string Broker::log() const {
  return content_of(folder_.file("log"));
}

}  // namespace telemime::meeting::test_support
