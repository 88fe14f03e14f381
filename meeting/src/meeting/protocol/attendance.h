// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace telemime::meeting {

/// Who takes part in a room, from the presence messages.
class Attendance {
 public:
  /// A presence message, or the empty one that clears it. One that says that an older session is gone does
  /// not remove a newer one; one that cannot be read changes nothing.
  void heard(const std::string& participant, std::string_view message);
  std::size_t count() const { return sessions_.size(); }
  bool has(const std::string& participant) const { return sessions_.contains(participant); }

 private:
  std::map<std::string, std::uint16_t> sessions_;
};

}  // namespace telemime::meeting
