// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/attendance.h"

#include "meeting/protocol/messages.h"

namespace telemime::meeting {
namespace {

constexpr std::size_t kMost = 1000;  // names come from outside: memory has a bound

}  // namespace

void Attendance::heard(const std::string& participant, std::string_view message) {
  if (message.empty()) {
    sessions_.erase(participant);
    return;
  }
  const auto presence = read_presence(message);
  if (!presence) {
    return;
  }
  const auto found = sessions_.find(participant);
  if (found == sessions_.end()) {
    if (presence->here && sessions_.size() < kMost) {
      sessions_.emplace(participant, presence->session);
    }
  } else if (presence->here) {
    found->second = presence->session;
  } else if (found->second == presence->session) {
    sessions_.erase(found);
  }
}

}  // namespace telemime::meeting
