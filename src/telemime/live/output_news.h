// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "telemime/live/message_level.h"
#include "telemime/streaming/sender.h"

namespace telemime {

/// Says once, in words, which outputs fail, and when they send again. To be asked now and then.
class OutputNews {
 public:
  struct Words {
    MessageLevel level = MessageLevel::info;
    std::string words;
  };

  /// What has changed since the last call. Who has not failed yet and sends is not news, nor is who tries
  /// again.
  std::vector<Words> look(std::span<const SenderStatus> outputs);

 private:
  std::map<std::string, bool> fails_;  // by URL
};

}  // namespace telemime
