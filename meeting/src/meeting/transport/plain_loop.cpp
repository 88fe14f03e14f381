// SPDX-License-Identifier: Apache-2.0
#include "meeting/transport/plain_loop.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <chrono>
#include <utility>

namespace telemime {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

namespace {

constexpr milliseconds kLook{50};
constexpr milliseconds kFirstPause{100};
constexpr milliseconds kLongestPause{5000};

}  // namespace

PlainLoop::PlainLoop(std::function<bool()> stop) : stop_(std::move(stop)) {}

bool PlainLoop::wait(const std::function<bool()>& done, milliseconds limit) {
  const auto end = SteadyClock::now() + limit;
  while (!done()) {
    if (stop_()) {
      throw LoopStopped{};
    }
    const auto now = SteadyClock::now();
    if (now >= end) {
      return false;
    }
    io_->run_one_until(std::min(end, now + kLook));
  }
  return true;
}

std::function<void()> PlainLoop::waker() {
  return [weak = std::weak_ptr(io_)] {
    if (const auto io = weak.lock()) {
      boost::asio::post(*io, [] {});
    }
  };
}

void PlainLoop::forget_old_handlers() {
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

}  // namespace telemime
