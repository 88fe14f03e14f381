// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace telemime::meeting {

/// Returns the port if a program can listen at it now (0: any free port), and nothing if it is taken.
/// `address` is a numeric IPv4 address. Throws Error(usage) when this computer does not have it, and
/// Error(output) for a port that is reserved.
std::optional<std::uint16_t> free_port(const std::string& address, std::uint16_t port);

/// The address at which other computers on the network most likely reach this one; "127.0.0.1" without a
/// network.
std::string own_address();

}  // namespace telemime::meeting
