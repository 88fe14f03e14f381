// SPDX-License-Identifier: Apache-2.0
#include "cut_network.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <unistd.h>

#include "broker.h"

namespace telemime::meeting::test_support {
namespace {

const std::string kTracker = "10.77.0.2";

void ip(std::vector<std::string> text) {
  text.insert(text.begin(), TELEMIME_IP);
  run(text);
}

}  // namespace

std::string CutNetwork::missing() {
  if (::geteuid() != 0) {
    return "network namespaces need root";
  }
  const int mine = ::open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC);
  const bool allowed = mine >= 0 && ::setns(mine, CLONE_NEWNET) == 0;
  ::close(mine);
  return allowed ? "" : "root cannot create network namespaces on this system (CAP_SYS_ADMIN)";
}

CutNetwork::CutNetwork()
    : broker_("telemime-broker-" + std::to_string(::getpid())),
      tracker_("telemime-tracker-" + std::to_string(::getpid())),
      home_(::open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC)) {
  ip({"netns", "add", broker_});
  ip({"netns", "add", tracker_});
  ip({"-n", broker_, "link", "add", "cable", "type", "veth", "peer", "name", "cable", "netns", tracker_});
  ip({"-n", broker_, "address", "add", broker() + "/24", "dev", "cable"});
  ip({"-n", tracker_, "address", "add", kTracker + "/24", "dev", "cable"});
  for (const std::string& side : {broker_, tracker_}) {
    ip({"-n", side, "link", "set", "lo", "up"});
    ip({"-n", side, "link", "set", "cable", "up"});
  }
  const int there = ::open(("/run/netns/" + broker_).c_str(), O_RDONLY | O_CLOEXEC);
  EXPECT_EQ(::setns(there, CLONE_NEWNET), 0);
  ::close(there);
}

CutNetwork::~CutNetwork() {
  EXPECT_EQ(::setns(home_, CLONE_NEWNET), 0);
  ::close(home_);
  ip({"netns", "delete", broker_});
  ip({"netns", "delete", tracker_});
}

std::vector<std::string> CutNetwork::at_tracker() const {
  return {TELEMIME_IP, "netns", "exec", tracker_};
}

// Packets to a hardware address that nobody has are lost silently.
void CutNetwork::cut() {
  const std::string nobody = "02:00:00:00:00:99";
  ip({"-n", broker_, "neighbour", "replace", kTracker, "lladdr", nobody, "nud", "permanent", "dev", "cable"});
  ip({"-n", tracker_, "neighbour", "replace", broker(), "lladdr", nobody, "nud", "permanent", "dev",
      "cable"});
}

void CutNetwork::mend() {
  ip({"-n", broker_, "neighbour", "delete", kTracker, "dev", "cable"});
  ip({"-n", tracker_, "neighbour", "delete", broker(), "dev", "cable"});
}

}  // namespace telemime::meeting::test_support
