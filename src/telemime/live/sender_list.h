// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "telemime/network/sender.h"

namespace telemime {

/// The outputs over the network: those that are sent to, and those that are off, which nothing is sent to.
/// Two URLs that mean the same (meaning_of) are one output. From any thread.
class SenderList {
 public:
  /// Sends there from now on. `keep`: for later runs, too (kept()). Throws Error(usage) when the URL cannot
  /// be used, is sent to already, or would be one too many (16).
  void add(const std::string& url, bool keep = false);
  /// An output of an earlier run: off, and kept. One that is listed already is only kept from now on. Throws
  /// as add() does.
  void offer(const std::string& url);
  /// Nothing is sent there any more; it stays in the list. False when there is none.
  bool switch_off(const std::string& url);
  /// Neither sent to nor listed nor kept. False when there is none.
  bool remove(const std::string& url);

  /// What a later run should offer, in the order in which they were added.
  std::vector<std::string> kept() const;

  void person(const StreamHeader& header);
  /// As Sender::send.
  void send(const MotionFrame& frame, double taken);
  std::vector<SenderStatus> status() const;

 private:
  struct Entry {
    std::string url;
    std::string meaning;
    std::shared_ptr<Sender> sender;  ///< none: off
    bool keep = false;
  };
  Entry* find(const std::string& meaning);
  void require_room() const;

  mutable std::mutex mutex_;
  std::vector<Entry> entries_;
  std::optional<StreamHeader> header_;
};

}  // namespace telemime
