// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "telemime/streaming/send_queue.h"

namespace telemime {

/// Returns the addresses of a host as text, IPv4 first, because most programs listen only there. Throws
/// LinkBroken with a message for the user if there are none.
using Lookup = std::function<std::vector<std::string>(const std::string& host)>;

/// Uses getaddrinfo, which blocks until the name servers respond.
std::vector<std::string> system_lookup(const std::string& host);

/// The same, but the destruction of the sender does not wait for it: a lookup in progress then ends in its
/// own thread. An address needs no lookup.
std::vector<std::string> resolve(SendLoop& loop, const std::string& host,
                                 const Lookup& lookup = system_lookup);

}  // namespace telemime
