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

/// What a connection sees of the thread that it lives in. All waiting is done by wait(); everything that
/// waits is an asynchronous operation of io().
class SendLoop {
 public:
  /// `stop` is asked by wait(): after each event, and at least every `check`.
  explicit SendLoop(std::function<bool()> stop,
                    std::chrono::milliseconds check = std::chrono::milliseconds(50));
  SendLoop(const SendLoop&) = delete;
  SendLoop& operator=(const SendLoop&) = delete;
  virtual ~SendLoop() = default;

  boost::asio::io_context& io() { return *io_; }
  /// Runs the handlers of io() until `done()` holds: true; false when `limit` has passed before. An exception
  /// of a handler (LinkBroken) comes out here. Throws LoopStopped once `stop` is true.
  bool wait(const std::function<bool()>& done, std::chrono::milliseconds limit);
  /// Ends a wait() early to have `done` asked again; may be called from any thread, also when the loop is
  /// gone.
  std::function<void()> waker() const;
  /// Runs the remaining handlers of a closed connection and ignores their exceptions.
  void discard_handlers();

  /// What is waited for before anything can be sent, for the status of a sender; a failure that stands there
  /// stays.
  virtual void waiting(const std::string& /*words*/) {}
  /// Frames arrive. `words` are for the status.
  virtual void sending(const std::string& /*words*/ = {}) {}
  virtual void receivers(std::int64_t /*count*/) {}

 private:
  const std::function<bool()> stop_;
  const std::chrono::milliseconds check_;
  const std::shared_ptr<boost::asio::io_context> io_;
  const std::shared_ptr<void> work_;  ///< io() has something to do as long as it exists
};

/// The pauses between attempts at something that failed: none, then 0.1 s, doubled up to 5 s.
class RetryPauses {
 public:
  /// What worked this long was good: its failure is a new one, after which the pauses start again.
  static constexpr std::chrono::seconds kGood{2};

  /// The pause before the next attempt, when the last one worked for this time.
  std::chrono::milliseconds next(std::chrono::steady_clock::duration worked);

 private:
  std::chrono::milliseconds next_{0};
};

}  // namespace telemime
