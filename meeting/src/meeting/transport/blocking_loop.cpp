// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/blocking_loop.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <chrono>
#include <utility>

namespace telemime::meeting {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

namespace {

constexpr milliseconds kCheck{50};
constexpr milliseconds kFirstPause{100};
constexpr milliseconds kLongestPause{5000};

}  // namespace

bool BlockingLoop::wait(const std::function<bool()>& done, milliseconds limit) {
  const auto end = SteadyClock::now() + limit;
  while (!done()) {
    if (stop_()) {
      throw LoopStopped{};
    }
    const auto now = SteadyClock::now();
    if (now >= end) {
      return false;
    }
    io_->run_one_until(std::min(end, now + kCheck));
  }
  return true;
}

std::function<void()> BlockingLoop::waker() {
  return [weak = std::weak_ptr(io_)] {
    if (const auto io = weak.lock()) {
      boost::asio::post(*io, [] {});
    }
  };
}

void BlockingLoop::discard_handlers() {
  for (;;) {
    try {
      if (io_->poll_one() == 0) {
        return;
      }
    } catch (const std::exception&) {
      continue;
    }
  }
}

milliseconds RetryPauses::next() {
  return std::exchange(next_, std::min(std::max(2 * next_, kFirstPause), kLongestPause));
}

}  // namespace telemime::meeting
