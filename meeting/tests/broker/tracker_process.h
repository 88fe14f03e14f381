// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>

#include <string>
#include <vector>

#include "broker.h"
#include "meeting/protocol/testing.h"
#include "telemime/core/scratch_folder.h"

namespace telemime::meeting::test_support {

/// A tracker in its own process (tracker_program.cpp). It ends with the test.
class TrackerProcess {
 public:
  /// `before`: a command that starts it, such as "ip netns exec NAME".
  explicit TrackerProcess(const std::string& url, std::vector<std::string> before = {}) {
    before.insert(before.end(), {TELEMIME_MEETING_TRACKER, url});
    process_ = start_program(before, folder_.file("output"));
  }
  TrackerProcess(const TrackerProcess&) = delete;
  TrackerProcess& operator=(const TrackerProcess&) = delete;
  ~TrackerProcess() { kill(); }

  /// Kills it, without a goodbye.
  void kill() { kill_process(process_); }
  void signal(int number) const { ::kill(process_, number); }
  std::string output() const { return content_of(folder_.file("output")); }

 private:
  ScratchFolder folder_;
  pid_t process_ = -1;
};

}  // namespace telemime::meeting::test_support
