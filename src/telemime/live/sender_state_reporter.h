// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "telemime/live/message_level.h"
#include "telemime/streaming/sender.h"

namespace telemime {

/// Reports once when an output fails, and once when it sends again. Poll it with update().
class SenderStateReporter {
 public:
  struct Report {
    MessageLevel level = MessageLevel::info;
    std::string text;
  };

  /// The changes since the last call. An output that sends from the start, or that only reconnects, is not
  /// reported.
  std::vector<Report> update(std::span<const SenderStatus> outputs);

 private:
  std::map<std::string, bool> failing_;  // by URL
};

}  // namespace telemime
