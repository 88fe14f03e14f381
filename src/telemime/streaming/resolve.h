// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "telemime/streaming/send_queue.h"

namespace telemime {

/// Addresses of a host as text, IPv4 first (most programs listen there alone); throws LinkBroken with
/// a message for the user when there is none.
using Lookup = std::function<std::vector<std::string>(const std::string& host)>;

/// getaddrinfo. Blocks, for as long as the name servers let it.
std::vector<std::string> system_lookup(const std::string& host);

/// The same without blocking the sender's end: a lookup that is under way when the sender is destroyed ends
/// by itself in a thread of its own. An address needs no lookup.
std::vector<std::string> resolve(SendLoop& loop, const std::string& host,
                                 const Lookup& lookup = system_lookup);

}  // namespace telemime
