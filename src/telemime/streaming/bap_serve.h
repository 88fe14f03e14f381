// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "telemime/streaming/sender.h"
#include "telemime/streaming/url.h"

namespace telemime {

/// Where VREng looks for its "vaps".
inline constexpr std::uint16_t kVapsPort = 4150;

/// bap+serve://[address]:4150[?profile=vreng-3.1|vreng-3.2|iso|greta]: a server in the manner of VREng's
/// "vaps". Clients connect by TCP and send the commands of bap_session.h; `play`, whatever the file, gives
/// them the live frames as datagrams: the header, then one for each frame, its mask and its values in one
/// line (line breaks are blanks there, as VREng needs it). An empty datagram is the end. Listens on loopback
/// unless the URL has another address; port 0 is any free one, which the status tells. Throws Error(usage).
std::unique_ptr<Sender> make_bap_serve_sender(const SendUrl& url);

/// Clients that may be connected at once; more are let go.
inline constexpr std::size_t kMostBapClients = 16;

}  // namespace telemime
