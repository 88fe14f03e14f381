// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "telemime/body/motion_frame.h"
#include "telemime/outputs/encoder.h"
#include "telemime/streaming/url.h"

namespace telemime {

enum class SenderState {
  connecting,
  sending,
  failed,
  off,  ///< there is no sender: the user has not switched it on
};

/// How an output over the network is doing.
struct SenderStatus {
  std::string url;  ///< as the user gave it, without a password
  SenderState state = SenderState::connecting;
  std::string words;           ///< what happened last and what will be done, for the user
  std::int64_t sent = 0;       ///< frames
  std::int64_t dropped = 0;    ///< frames that the receiver was too slow or too dead for
  std::int64_t receivers = 0;  ///< that take part now; 1 for the ones that cannot tell
};

/// Sends frames to another program. Nothing here blocks or throws once it is made: a thread of its own
/// connects, writes, and tries again after a failure (first at once, then ever less often, every 5 s at
/// most); a short queue keeps the newest frames and drops the oldest.
class Sender {
 public:
  Sender() = default;
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;
  /// Stops at once, whatever the receiver does.
  virtual ~Sender() = default;

  /// The person whose frames follow. Called again after a recalibration.
  virtual void begin(const StreamHeader& header) = 0;
  /// `taken`: when the camera took the picture, ms of the program's monotonic clock.
  virtual void send(const MotionFrame& frame, double taken) = 0;
  virtual SenderStatus status() const = 0;
};

/// One way to send frames to other programs.
struct SenderKind {
  std::string_view scheme;   ///< before "://"
  std::uint16_t port = 0;    ///< when the URL names none; 0: it must
  std::string_view example;  ///< a URL that can be typed as it is
  std::string_view options;  ///< behind "?", for the user; the first value of each is the default
  std::string_view summary;
  /// Throws Error(usage) when the URL cannot be used.
  std::unique_ptr<Sender> (*make)(const SendUrl&);
  UrlCredentials credentials = UrlCredentials::rejected;
};

using SenderKinds = std::span<const SenderKind>;

/// The kinds of this module (all.h); a program may know more.
SenderKinds sender_kinds();

/// By the scheme of the URL: one of `kinds`. Throws Error(usage) for one that is unknown or
/// malformed; the message shows a valid one.
std::unique_ptr<Sender> make_sender(const std::string& url, SenderKinds kinds = sender_kinds());

/// What the URL means, as text: two that mean the same output have the same one. The scheme, the user, the
/// host (localhost is 127.0.0.1), port, path and options, with what the URL
/// leaves out filled in; a password does not count. Throws as make_sender does for a URL that cannot be
/// parsed or has an unknown scheme.
std::string meaning_of(const std::string& url, SenderKinds kinds = sender_kinds());

}  // namespace telemime
