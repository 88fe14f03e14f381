// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>

#include "telemime/streaming/send_queue.h"

namespace telemime::meeting {

/// Ends the waiting of a BlockingLoop. Not derived from std::exception, so that general handlers do not catch
/// it.
struct LoopStopped {};

/// A SendLoop that runs in the calling thread, without the queue and status of a sender.
class BlockingLoop final : public SendLoop {
 public:
  /// `stop` is checked every 50 ms and after each event; once it is true, wait() throws LoopStopped.
  explicit BlockingLoop(std::function<bool()> stop) : stop_(std::move(stop)) {}

  boost::asio::io_context& io() override { return *io_; }
  bool wait(const std::function<bool()>& done, std::chrono::milliseconds limit) override;
  std::function<void()> waker() override;
  void waiting(const std::string& /*text*/) override {}
  void sending(const std::string& /*text*/) override {}
  void receivers(std::int64_t /*count*/) override {}
  /// Runs the remaining handlers of a closed connection and ignores their exceptions.
  void discard_handlers();

 private:
  const std::function<bool()> stop_;
  const std::shared_ptr<boost::asio::io_context> io_ = std::make_shared<boost::asio::io_context>(1);
  const boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{io_->get_executor()};
};

/// Growing pauses between attempts: none, then 0.1 s, doubled up to 5 s.
class RetryPauses {
 public:
  std::chrono::milliseconds next();
  /// Starts again with no pause.
  void reset() { next_ = std::chrono::milliseconds{0}; }

 private:
  std::chrono::milliseconds next_{0};
};

}  // namespace telemime::meeting
