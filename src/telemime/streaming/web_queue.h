// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <deque>
#include <memory>
#include <optional>
#include <set>
#include <string>

namespace telemime {

/// A WebSocket message on its way out. The bytes are shared by all clients.
struct WebMessage {
  int topic = 0;
  bool binary = false;
  std::shared_ptr<const std::string> bytes;
};

/// Messages that wait for one client. All messages of topic 0 are sent first, in order. Of each other topic
/// only the newest is kept, in the place of the one that it replaces, so that topics take turns.
class WebQueue {
 public:
  /// `most_important`: largest number of waiting messages of topic 0.
  explicit WebQueue(std::size_t most_important = 1000) : most_important_(most_important) {}

  /// Returns false, without adding the message, if too many of topic 0 are waiting. Drops messages of a topic
  /// that is off.
  bool push(WebMessage message);
  std::optional<WebMessage> pop();
  /// Topic 0 is always on.
  void set_topic(int topic, bool on);
  std::size_t size() const { return important_.size() + newest_.size(); }

 private:
  std::size_t most_important_;
  std::deque<WebMessage> important_;
  std::deque<WebMessage> newest_;
  std::set<int> off_;
};

}  // namespace telemime
