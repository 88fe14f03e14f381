// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "telemime/streaming/send_loop.h"
#include "telemime/streaming/sender.h"
#include "telemime/streaming/url.h"

namespace telemime {

/// One kind of output: how it connects and writes. Called only from the sender's thread.
class Link {
 public:
  Link() = default;
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;
  virtual ~Link() = default;

  /// Connects. Throws LinkBroken.
  virtual void open() = 0;
  /// Announces the person whose frames follow. Called after each open() and after a recalibration.
  virtual void person(const std::shared_ptr<const StreamHeader>& person) = 0;
  /// Writes a frame; `taken` as in Sender::send. Returns false if there is no receiver, which is not a
  /// failure. Throws LinkBroken.
  virtual bool frame(const MotionFrame& frame, double taken) = 0;
  /// Closes the connection. Called after each open(), even if it failed.
  virtual void close() noexcept = 0;
};

using MakeLink = std::function<std::unique_ptr<Link>(SendLoop&)>;

/// A sender that runs a Link in its own thread, with its own queue. Handles the option `mirror` of the URL:
/// the Link then receives mirrored frames.
std::unique_ptr<Sender> make_queued_sender(const SendUrl& url, const MakeLink& make_link);

/// Largest number of frames that wait for a slow receiver; the oldest are dropped.
inline constexpr std::size_t kSendQueueFrames = 4;

}  // namespace telemime
