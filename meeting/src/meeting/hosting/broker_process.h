// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/types.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <thread>

namespace telemime::meeting {

/// Runs the broker's program in a thread, which reads its output and restarts it when it ends. The program is
/// also killed when this process dies.
class BrokerProcess {
 public:
  /// A message for the user, from that thread.
  using Report = std::function<void(const std::string& text)>;

  /// Starts the program. Throws Error(output) when that is impossible.
  BrokerProcess(std::filesystem::path program, std::filesystem::path configuration, Report report);
  BrokerProcess(const BrokerProcess&) = delete;
  BrokerProcess& operator=(const BrokerProcess&) = delete;
  /// Terminates the program, and kills it after 3 s.
  ~BrokerProcess();

  /// From now on restarts the program when it ends, after pauses that grow to 5 s. Reports why; the same
  /// reason only once, unless a run lasts longer than 5 s.
  void keep_running();
  /// The number of the current run, from 1; 0 between runs. From any thread, like all below.
  std::uint64_t run() const;
  bool has_ended() const { return run() == 0; }
  /// Sends a signal to that run, if it is still the current one.
  bool signal(std::uint64_t run, int number) const;
  pid_t process() const;
  /// The end of its output.
  std::string last_output() const;
  /// How the last run ended, with the last line of its output: "code 1: Error: Address already in use". Empty
  /// during a run.
  std::string ending() const;

 private:
  void work();
  void start();
  void watch();
  void append_output(const char* text, std::size_t size);
  std::string end_of_run();
  bool wait(int milliseconds) const;
  void stop_child() const;

  const std::filesystem::path program_;
  const std::filesystem::path configuration_;
  const Report report_;
  mutable std::mutex mutex_;  ///< of what follows
  pid_t process_ = -1;
  int output_ = -1;
  int end_ = -1;  ///< pidfd, readable when the program has ended
  std::uint64_t runs_ = 0;
  bool running_ = true;  ///< or about to, until the thread finds otherwise
  bool restart_ = false;
  std::string text_;
  std::string ending_;
  int wake_ = -1;  ///< eventfd, to end the thread
  std::thread thread_;
};

/// The path of Mosquitto: `given`, or the first one in PATH, /usr/sbin and /usr/local/sbin. Throws
/// Error(usage) when there is none.
std::filesystem::path find_mosquitto(const std::string& given, const char* path);

}  // namespace telemime::meeting
