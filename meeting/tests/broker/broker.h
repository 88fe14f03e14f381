// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "telemime/core/scratch_folder.h"

namespace telemime::meeting::test_support {

/// A Mosquitto on a port of loopback, with a configuration of its own. It ends with the test.
class Broker {
 public:
  struct Account {
    std::string user;
    std::string password;
    std::string rights;  ///< lines of an ACL file: "topic read r/home/studio/#\n"
  };

  /// Which of the computer's addresses it listens at.
  enum class Where { loopback, everywhere };

  /// Who comes may do all.
  explicit Broker(Where where);
  /// Who comes may do all; or only `accounts` may, each what its rights say.
  explicit Broker(const std::vector<Account>& accounts = {});
  /// TLS with this certificate and its key, files in PEM form.
  Broker(const std::string& certificate, const std::string& key);
  Broker(const Broker&) = delete;
  Broker& operator=(const Broker&) = delete;
  ~Broker();

  std::uint16_t port() const { return port_; }
  /// "mqtt://127.0.0.1:port/home/studio" with `user` ("name:password@") before the host.
  std::string url(const std::string& user = "") const;
  /// Kills it: connections break, and all that it kept is lost.
  void kill();
  /// Starts it at the same port.
  void start();
  /// What it has written.
  std::string log() const;

 private:
  void choose_port(const std::string& more);
  bool try_start();

  ScratchFolder folder_;
  std::string address_ = " 127.0.0.1";
  std::uint16_t port_ = 0;
  pid_t process_ = -1;
};

/// Starts a program whose output goes to a file. It does not outlive the thread that calls this.
pid_t start_program(const std::vector<std::string>& words, const std::string& output);

/// Runs a program and waits for its end; fails the test unless that is 0.
void run(const std::vector<std::string>& words);

}  // namespace telemime::meeting::test_support
