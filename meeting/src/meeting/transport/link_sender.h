// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>

#include "telemime/streaming/sender.h"
#include "telemime/streaming/url.h"

namespace telemime::meeting {

inline constexpr std::uint16_t kHttpsPort = 443;

/// http(s)://host[:port]/room[?name=Ana&look=plain&seat=3]#k=INVITE: enters the room by its link
/// (room_entry.h), then takes part as the senders of mqtt:// do. After a break it enters again, with the way
/// back to its seat. Throws Error(usage).
std::unique_ptr<Sender> make_link_sender(const SendUrl& url);

}  // namespace telemime::meeting
