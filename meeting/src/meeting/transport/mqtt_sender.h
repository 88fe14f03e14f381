// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "meeting/transport/meeting_link.h"
#include "telemime/streaming/sender.h"
#include "telemime/streaming/url.h"

namespace telemime::meeting {

inline constexpr std::uint16_t kMqttPort = 1883;
inline constexpr std::uint16_t kMqttsPort = 8883;

/// What the URL below names. Throws Error(usage).
MeetingOutput meeting_output_of(const SendUrl& url);

/// mqtt://[user:password@]host[:1883]/tenant/room[?name=Ana&look=plain&...], or mqtts:// with TLS: takes part
/// in a room (docs/room-protocol.md). The account comes from the URL, from the file of the option `key`, or
/// from the environment (mqtt_key.h). A sender that ends says goodbye, for half a second at most. Throws
/// Error(usage).
std::unique_ptr<Sender> make_mqtt_sender(const SendUrl& url);

}  // namespace telemime::meeting
