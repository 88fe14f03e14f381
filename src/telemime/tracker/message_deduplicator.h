// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <utility>

namespace telemime {

/// Remembers which messages the user has seen, so that a message that comes up in every frame is shown once.
/// Messages that differ in their numbers alone count as the same.
class MessageDeduplicator {
 public:
  bool first_time(std::string message) {
    std::erase_if(message, [](char c) { return c >= '0' && c <= '9'; });
    return seen_.insert(std::move(message)).second;
  }
  void forget() { seen_.clear(); }

 private:
  std::set<std::string> seen_;
};

}  // namespace telemime
