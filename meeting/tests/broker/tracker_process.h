// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>
#include <sys/wait.h>

#include <fstream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "broker.h"
#include "telemime/core/scratch_folder.h"

namespace telemime::meeting::test_support {

/// A tracker in a process of its own (tracker_program.cpp). It ends with the test.
class TrackerProcess {
 public:
  /// `before`: words of a command that starts it, as "ip netns exec NAME".
  explicit TrackerProcess(const std::string& url, std::vector<std::string> before = {}) {
    before.insert(before.end(), {TELEMIME_MEETING_TRACKER, url});
    process_ = start_program(before, folder_.file("output"));
  }
  TrackerProcess(const TrackerProcess&) = delete;
  TrackerProcess& operator=(const TrackerProcess&) = delete;
  ~TrackerProcess() { kill(); }

  /// Without a word to anybody.
  void kill() {
    if (process_ > 0) {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
      process_ = -1;
    }
  }
  void signal(int number) const { ::kill(process_, number); }
  std::string output() const {
    std::ifstream in(folder_.file("output"));
    return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  }

 private:
  ScratchFolder folder_;
  pid_t process_ = -1;
};

}  // namespace telemime::meeting::test_support
