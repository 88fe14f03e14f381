// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "telemime/streaming/sender.h"
#include "telemime/streaming/url.h"

namespace telemime {

inline constexpr std::uint16_t kHttpPort = 80;

/// ws://host[:80][/path][?...]: connects as a WebSocket client and sends the messages `body` and `pose` of
/// docs/live-protocol.md as text. `mirror` is an option of ours; the rest of what stands behind "?" goes to
/// the receiver with the path. Throws Error(usage).
std::unique_ptr<Sender> make_web_socket_sender(const SendUrl& url);

}  // namespace telemime
