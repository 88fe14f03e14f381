// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace telemime::meeting {

/// The port itself where a program can listen at it now, with port 0 any such port; nothing when it is taken.
/// `address` is IPv4, in numbers. Throws Error(usage) when it is no address of this computer.
std::optional<std::uint16_t> free_port(const std::string& address, std::uint16_t port);

/// The address that other computers of the same network most likely reach this one at; "127.0.0.1" when there
/// is none.
std::string own_address();

}  // namespace telemime::meeting
