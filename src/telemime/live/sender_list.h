// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "telemime/streaming/sender.h"

namespace telemime {

/// The network outputs of a live run, at most 16, each on or off. URLs that mean the same (meaning_of) are
/// one output. status() omits the passwords in URLs. Thread-safe.
class SenderList {
 public:
  explicit SenderList(SenderKinds kinds = sender_kinds()) : kinds_(kinds) {}
  SenderKinds kinds() const { return kinds_; }

  /// Adds an output, or switches one on; a URL without its password then uses the known password. Returns
  /// whether it was not in the list. Throws Error(usage) if the URL is invalid, if the output is on already,
  /// or if the list is full.
  bool add(const std::string& given);
  /// Adds an output of an earlier run, off. One that is already listed is not changed. Throws as add() does.
  void offer(const std::string& url);
  /// Stops sending; the output stays in the list. False if it is not listed.
  bool switch_off(const std::string& url) { return end(url, /*remove=*/false); }
  /// Stops sending and removes the output from the list. False if it is not listed.
  bool remove(const std::string& url) { return end(url, /*remove=*/true); }

  void person(const StreamHeader& header);
  /// Sends a frame to every output that is on, as Sender::send.
  void send(const MotionFrame& frame, double taken);
  std::vector<SenderStatus> status() const;

 private:
  struct Entry {
    std::string url;  ///< including the password
    std::string meaning;
    std::shared_ptr<Sender> sender;  ///< null if it is off
  };
  Entry* find(const std::string& meaning);
  void require_space() const;
  bool end(const std::string& url, bool remove);
  /// The URL to send to, including a password that the page does not know. Throws if the output cannot be
  /// added. The caller holds the lock.
  std::string url_of_new(const std::string& given, const std::string& meaning);

  const SenderKinds kinds_;
  mutable std::mutex mutex_;
  std::vector<Entry> entries_;
  std::optional<StreamHeader> header_;
};

}  // namespace telemime
