// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>
#include <utility>

namespace telemime {

/// What the user was told already, so that nothing is said at every frame: words that differ in their numbers
/// alone are the same.
class Told {
 public:
  /// True the first time.
  bool is_new(std::string words) {
    std::erase_if(words, [](char c) { return c >= '0' && c <= '9'; });
    return told_.insert(std::move(words)).second;
  }
  void forget() { told_.clear(); }

 private:
  std::set<std::string> told_;
};

}  // namespace telemime
