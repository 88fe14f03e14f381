// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_queue.h"

#include <algorithm>
#include <utility>

namespace telemime {
bool WebQueue::push(WebMessage message) {
  if (message.topic == 0) {
    if (important_.size() >= most_important_) {
      return false;
    }
    important_.push_back(std::move(message));
    return true;
  }
  if (off_.contains(message.topic)) {
    return true;
  }
  const auto waiting = std::find_if(newest_.begin(), newest_.end(),
                                    [&](const WebMessage& other) { return other.topic == message.topic; });
  if (waiting == newest_.end()) {
    newest_.push_back(std::move(message));
  } else {
    *waiting = std::move(message);
  }
  return true;
}

std::optional<WebMessage> WebQueue::pop() {
  std::deque<WebMessage>& from = important_.empty() ? newest_ : important_;
  if (from.empty()) {
    return std::nullopt;
  }
  std::optional<WebMessage> next = std::move(from.front());
  from.pop_front();
  return next;
}

void WebQueue::set_topic(int topic, bool on) {
  if (topic == 0) {
    return;
  }
  if (on) {
    off_.erase(topic);
    return;
  }
  off_.insert(topic);
  std::erase_if(newest_, [&](const WebMessage& message) { return message.topic == topic; });
}

}  // namespace telemime
