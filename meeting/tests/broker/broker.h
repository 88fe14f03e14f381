// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <string>
#include <vector>

#include "telemime/core/scratch_folder.h"

namespace telemime::meeting::test_support {

/// A Mosquitto on a loopback port with its own configuration. It ends with the test.
class Broker {
 public:
  struct Account {
    std::string user;
    std::string password;
    std::string rights;  ///< lines of an ACL file: "topic read r/home/studio/#\n"
  };

  /// The addresses that it listens at.
  enum class Where { loopback, everywhere };

  /// Allows everyone everything.
  explicit Broker(Where where);
  /// With the rights of these accounts; without accounts it allows everyone everything.
  explicit Broker(const std::vector<Account>& accounts = {});
  /// With TLS: a certificate and its key in PEM form.
  Broker(const std::string& certificate, const std::string& key);
  Broker(const Broker&) = delete;
  Broker& operator=(const Broker&) = delete;
  ~Broker();

  std::uint16_t port() const { return port_; }
  /// "mqtt://127.0.0.1:port/home/studio" with `user` ("name:password@") before the host.
  std::string url(const std::string& user = "") const;
  /// Kills it: connections break and retained messages are lost.
  void kill();
  /// Starts it again at the same port.
  void start();
  /// Its output.
  std::string log() const;

 private:
  void choose_port(const std::string& more);
  bool try_start();

  ScratchFolder folder_;
  std::string address_ = " 127.0.0.1";
  std::uint16_t port_ = 0;
  pid_t process_ = -1;
};

/// Starts a program whose output goes to a file. It ends with the calling thread.
pid_t start_program(const std::vector<std::string>& text, const std::string& output);

/// Kills a process and waits for its end; sets the id to -1.
void kill_process(pid_t& process);

/// Runs a program to its end; fails the test unless its exit code is 0.
void run(const std::vector<std::string>& text);

}  // namespace telemime::meeting::test_support
