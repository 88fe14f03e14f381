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

/// What waits for one client: all of topic 0, in order, which go first; of each other topic the newest, which
/// keeps the place of the one that it replaces, so that topics take turns.
class WebQueue {
 public:
  /// `most_important`: of topic 0.
  explicit WebQueue(std::size_t most_important = 1000) : most_important_(most_important) {}

  /// False when too many of topic 0 wait: the message is not taken. One of a topic that is off is dropped.
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
