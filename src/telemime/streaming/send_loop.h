// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

namespace boost::asio {
class io_context;
}

namespace telemime {

/// The connection is lost or cannot be made. The message gives the reason, without "trying again".
class LinkBroken : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Ends the waiting of a SendLoop. Not derived from std::exception, so that general handlers do not catch it.
struct LoopStopped {};

/// The sender's thread as its connection sees it. A connection waits only in wait(), for asynchronous
/// operations of io().
class SendLoop {
 public:
  /// wait() calls `stop` after each event, and at least every `check`.
  explicit SendLoop(std::function<bool()> stop,
                    std::chrono::milliseconds check = std::chrono::milliseconds(50));
  SendLoop(const SendLoop&) = delete;
  SendLoop& operator=(const SendLoop&) = delete;
  virtual ~SendLoop() = default;

  boost::asio::io_context& io() { return *io_; }
  /// Runs the handlers of io() until `done()` is true. Returns false if `limit` passes before that. Passes on
  /// exceptions of handlers (LinkBroken). Throws LoopStopped as soon as `stop` returns true.
  bool wait(const std::function<bool()>& done, std::chrono::milliseconds limit);
  /// Makes wait() check `done` now. May be called from any thread, even after the loop is destroyed.
  std::function<void()> waker() const;
  /// Runs the remaining handlers of a closed connection and ignores their exceptions.
  void discard_handlers();

  /// Sets the status of the sender to what it is waiting for; does not replace a failure that is shown there.
  virtual void waiting(const std::string& /*words*/) {}
  /// Frames are arriving. `words` are for the status.
  virtual void sending(const std::string& /*words*/ = {}) {}
  virtual void receivers(std::int64_t /*count*/) {}

 private:
  const std::function<bool()> stop_;
  const std::chrono::milliseconds check_;
  const std::shared_ptr<boost::asio::io_context> io_;
  const std::shared_ptr<void> work_;  ///< keeps io() running
};

/// The pauses between attempts to connect: none, then 0.1 s, doubled up to 5 s.
class RetryPauses {
 public:
  /// A connection that worked for this long counts as good: after it the pauses start again.
  static constexpr std::chrono::seconds kGood{2};

  /// The pause before the next attempt, if the last connection worked for this time.
  std::chrono::milliseconds next(std::chrono::steady_clock::duration worked);

 private:
  std::chrono::milliseconds next_{0};
};

}  // namespace telemime
