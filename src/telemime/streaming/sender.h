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
  off,  ///< there is no sender: the user has not turned it on
};

/// State of an output over the network.
struct SenderStatus {
  std::string url;  ///< as the user gave it, without a password
  SenderState state = SenderState::connecting;
  std::string words;           ///< what happened last and what happens next, for the user
  std::int64_t sent = 0;       ///< frames
  std::int64_t dropped = 0;    ///< frames that a slow or missing receiver did not take
  std::int64_t receivers = 0;  ///< connected now; 1 for outputs that cannot know
};

/// Sends frames to another program. After construction nothing blocks or throws: a thread connects, writes
/// and retries after a failure, first at once, then with pauses that grow to 5 s. A short queue keeps the
/// newest frames and drops the oldest.
class Sender {
 public:
  Sender() = default;
  Sender(const Sender&) = delete;
  Sender& operator=(const Sender&) = delete;
  /// Stops at once, regardless of the receiver.
  virtual ~Sender() = default;

  /// Announces the person whose frames follow; again after a recalibration.
  virtual void begin(const StreamHeader& header) = 0;
  /// `taken`: when the camera took the image, ms of the program's monotonic clock.
  virtual void send(const MotionFrame& frame, double taken) = 0;
  virtual SenderStatus status() const = 0;
};

/// One way to send frames to other programs.
struct SenderKind {
  std::string_view scheme;   ///< before "://"
  std::uint16_t port = 0;    ///< if the URL names none; 0: it must name one
  std::string_view example;  ///< a URL that works as it is
  std::string_view options;  ///< after "?", for the user; the first value of each is the default
  std::string_view summary;
  /// Throws Error(usage) if the URL cannot be used.
  std::unique_ptr<Sender> (*make)(const SendUrl&);
  UrlCredentials credentials = UrlCredentials::rejected;
};

using SenderKinds = std::span<const SenderKind>;

/// The kinds of this module (all.h); a program may have more.
SenderKinds sender_kinds();

/// Makes the sender of that one of `kinds` that the URL's scheme names. Throws Error(usage), with a valid URL
/// in the message, if the scheme is unknown or the URL malformed.
std::unique_ptr<Sender> make_sender(const std::string& url, SenderKinds kinds = sender_kinds());

/// The normal form of a URL: scheme, user, host (127.0.0.1 for localhost), port, path and options, with
/// defaults filled in and without the password. Two URLs of the same output have the same normal form. Throws
/// like make_sender if the URL cannot be parsed or its scheme is unknown.
std::string meaning_of(const std::string& url, SenderKinds kinds = sender_kinds());

}  // namespace telemime
