// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "telemime/streaming/sender.h"
#include "telemime/streaming/url.h"

namespace boost::asio {
class io_context;
}

namespace telemime {

/// The connection is lost or cannot be made. The message gives the reason, without "trying again".
class LinkBroken : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What a Link sees of the thread that it lives in. All waiting is done by wait(), which ends when the sender
/// is destroyed; everything that waits is an asynchronous operation of io().
class SendLoop {
 public:
  SendLoop() = default;
  SendLoop(const SendLoop&) = delete;
  SendLoop& operator=(const SendLoop&) = delete;
  virtual ~SendLoop() = default;

  virtual boost::asio::io_context& io() = 0;
  /// Runs the handlers of io() until `done()` holds: true; false when `limit` has passed before. An exception
  /// of a handler (LinkBroken) comes out here. Throws something that only the thread itself catches when the
  /// sender is being destroyed.
  virtual bool wait(const std::function<bool()>& done, std::chrono::milliseconds limit) = 0;
  /// Ends a wait() early to have `done` asked again; may be called from any thread, also when the loop is
  /// gone.
  virtual std::function<void()> waker() = 0;

  /// What is waited for before anything can be sent, for the status; a failure that stands there stays.
  virtual void waiting(const std::string& words) = 0;
  /// Frames arrive. `words` are for the status.
  virtual void sending(const std::string& words = {}) = 0;
  virtual void receivers(std::int64_t count) = 0;
};

/// One kind of output: how it connects and how it writes. Only the sender's thread calls it.
class Link {
 public:
  Link() = default;
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;
  virtual ~Link() = default;

  /// Connects. Throws LinkBroken.
  virtual void open() = 0;
  /// The person whose frames follow: after each open(), and after a recalibration.
  virtual void person(const std::shared_ptr<const StreamHeader>& person) = 0;
  /// Writes a frame; `taken` as in Sender::send. False when there was nobody to send it to, which is no
  /// failure. Throws LinkBroken.
  virtual bool frame(const MotionFrame& frame, double taken) = 0;
  /// Lets go of the connection. Called after each open(), also after one that failed.
  virtual void close() noexcept = 0;
};

using MakeLink = std::function<std::unique_ptr<Link>(SendLoop&)>;

/// A sender with a thread and a queue of its own around a Link. Reads the option `mirror` of the URL: then
/// the Link sees the person as in a mirror.
std::unique_ptr<Sender> make_queued_sender(const SendUrl& url, const MakeLink& make_link);

/// How many frames wait for a slow receiver at most; the newest stay.
inline constexpr std::size_t kSendQueueFrames = 4;

}  // namespace telemime
