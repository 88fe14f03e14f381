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

/// The broker's program in the care of a thread: it hears what the program says, starts it anew when it has
/// ended, and ends it. When this process dies, however, the program is killed.
class BrokerProcess {
 public:
  /// Words for the user, from that thread.
  using Tell = std::function<void(const std::string& words)>;

  /// Starts it. Throws Error(output) where there is no thread.
  BrokerProcess(std::filesystem::path program, std::filesystem::path configuration, Tell tell);
  BrokerProcess(const BrokerProcess&) = delete;
  BrokerProcess& operator=(const BrokerProcess&) = delete;
  /// Asks it to end, and kills it when it has not after 3 s.
  ~BrokerProcess();

  /// From now on it is started anew when it has ended, after pauses that grow to 5 s. The user is told why;
  /// the same reason once, as long as no run lasts longer than 5 s.
  void keep_running();
  /// The number of the run that is under way, from 1; 0: none is. From any thread, as what follows.
  std::uint64_t run() const;
  bool has_ended() const { return run() == 0; }
  /// Sends a signal to that run, if it is still under way.
  bool signal(std::uint64_t run, int number) const;
  pid_t process() const;
  /// The last that it said.
  std::string last_words() const;
  /// How the last run ended, with the last line of what it said: "code 1: Error: Address already in use".
  /// Empty while one is under way.
  std::string ending() const;

 private:
  void work();
  void start();
  void listen();
  void hear(const char* text, std::size_t size);
  std::string end_of_run();
  bool wait(int milliseconds) const;
  void stop_child() const;

  const std::filesystem::path program_;
  const std::filesystem::path configuration_;
  const Tell tell_;
  mutable std::mutex mutex_;  ///< of what follows
  pid_t process_ = -1;
  int output_ = -1;
  int end_ = -1;  ///< pidfd: readable when the program has ended
  std::uint64_t runs_ = 0;
  bool running_ = true;  ///< or about to be, until the thread says otherwise
  bool again_ = false;
  std::string said_;
  std::string ending_;
  int wake_ = -1;  ///< eventfd: end
  std::thread thread_;
};

/// Mosquitto's program: `given`, or else the first of PATH, /usr/sbin and /usr/local/sbin. Throws
/// Error(usage) when there is none.
std::filesystem::path find_mosquitto(const std::string& given, const char* path);

}  // namespace telemime::meeting
