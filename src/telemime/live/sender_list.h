// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "telemime/streaming/sender.h"

namespace telemime {

/// The outputs over the network: those that are sent to, and those that are off, which nothing is sent to.
/// Two URLs that mean the same (meaning_of) are one output. Passwords in URLs are used and told to nobody:
/// status() leaves them out. From any thread.
class SenderList {
 public:
  explicit SenderList(SenderKinds kinds = sender_kinds()) : kinds_(kinds) {}
  SenderKinds kinds() const { return kinds_; }

  /// Sends there from now on. Throws Error(usage) when the URL cannot be used, is sent to already, or would
  /// be one too many (16). One that is off is known with the password that it was added with.
  void add(const std::string& given);
  /// An output of an earlier run: off. One that is listed already stays as it is. Throws as add() does.
  void offer(const std::string& url);
  /// Nothing is sent there any more; it stays in the list. False when there is none.
  bool switch_off(const std::string& url);
  /// Neither sent to nor listed. False when there is none.
  bool remove(const std::string& url);

  void person(const StreamHeader& header);
  /// As Sender::send.
  void send(const MotionFrame& frame, double taken);
  std::vector<SenderStatus> status() const;

 private:
  struct Entry {
    std::string url;  ///< with its password
    std::string meaning;
    std::shared_ptr<Sender> sender;  ///< none: off
  };
  Entry* find(const std::string& meaning);
  void require_room() const;
  /// Where an output that is to be added sends: a page knows outputs without their passwords. Throws when it
  /// cannot be added. The lock is held.
  std::string url_of_new(const std::string& given, const std::string& meaning);

  const SenderKinds kinds_;
  mutable std::mutex mutex_;
  std::vector<Entry> entries_;
  std::optional<StreamHeader> header_;
};

}  // namespace telemime
