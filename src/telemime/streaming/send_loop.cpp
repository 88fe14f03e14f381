// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/send_loop.h"

#include <algorithm>
#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <utility>

namespace telemime {

using std::chrono::milliseconds;
using SteadyClock = std::chrono::steady_clock;

namespace {

constexpr milliseconds kFirstPause{100};
constexpr milliseconds kLongestPause{5000};

}  // namespace

SendLoop::SendLoop(std::function<bool()> stop, milliseconds check)
    : stop_(std::move(stop)),
      check_(check),
      io_(std::make_shared<boost::asio::io_context>(1)),
      work_(std::make_shared<boost::asio::executor_work_guard<boost::asio::io_context::executor_type>>(
          io_->get_executor())) {}

bool SendLoop::wait(const std::function<bool()>& done, milliseconds limit) {
  const auto end = SteadyClock::now() + limit;
  while (!done()) {
    if (stop_()) {
      throw LoopStopped{};
    }
    const auto now = SteadyClock::now();
    if (now >= end) {
      return false;
    }
    io_->run_one_until(std::min(end, now + check_));
  }
  return true;
}

std::function<void()> SendLoop::waker() const {
  return [weak = std::weak_ptr(io_)] {
    if (const auto io = weak.lock()) {
      boost::asio::post(*io, [] {});
    }
  };
}

void SendLoop::discard_handlers() {
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

milliseconds RetryPauses::next(SteadyClock::duration worked) {
  if (worked >= kGood) {
    next_ = milliseconds{0};
  }
  return std::exchange(next_, std::clamp(2 * next_, kFirstPause, kLongestPause));
}

}  // namespace telemime
