// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <memory>

#include "telemime/streaming/send_loop.h"
#include "telemime/streaming/sender.h"
#include "telemime/streaming/url.h"

namespace telemime {

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
