// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <functional>
#include <memory>

#include "telemime/streaming/send_queue.h"

namespace telemime::meeting {

/// Ends a BlockingLoop's waiting. Not a std::exception: nobody but who asked for it shall catch it.
struct LoopStopped {};

/// A SendLoop in the thread that calls it, without a sender's queue and status.
class BlockingLoop final : public SendLoop {
 public:
  /// `stop` is asked every 50 ms, and whenever something happened; once it holds, wait() throws LoopStopped.
  explicit BlockingLoop(std::function<bool()> stop);

  boost::asio::io_context& io() override { return *io_; }
  bool wait(const std::function<bool()>& done, std::chrono::milliseconds limit) override;
  std::function<void()> waker() override;
  void waiting(const std::string& /*words*/) override {}
  void sending(const std::string& /*words*/) override {}
  void receivers(std::int64_t /*count*/) override {}
  /// Runs what a closed connection has left behind, and passes over its complaints.
  void forget_old_handlers();

 private:
  const std::function<bool()> stop_;
  const std::shared_ptr<boost::asio::io_context> io_ = std::make_shared<boost::asio::io_context>(1);
  const boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{io_->get_executor()};
};

/// Growing pauses between attempts: none, then 0.1 s, doubled up to 5 s.
class RetryPauses {
 public:
  std::chrono::milliseconds next();
  /// The next failure is a new one.
  void reset() { next_ = std::chrono::milliseconds{0}; }

 private:
  std::chrono::milliseconds next_{0};
};

}  // namespace telemime::meeting
