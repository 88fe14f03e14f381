// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "telemime/network/sender.h"

namespace telemime {

/// The outputs over the network that are open now. From any thread.
class SenderList {
 public:
  /// Throws Error(usage) when the URL cannot be used, is open already, or would be one too many (16).
  void add(const std::string& url);
  /// False when there is none of that URL.
  bool remove(const std::string& url);

  void person(const StreamHeader& header);
  void send(const MotionFrame& frame);
  std::vector<SenderStatus> status() const;

 private:
  struct Entry {
    std::string url;
    std::shared_ptr<Sender> sender;
  };
  mutable std::mutex mutex_;
  std::vector<Entry> entries_;
  std::optional<StreamHeader> header_;
};

}  // namespace telemime
