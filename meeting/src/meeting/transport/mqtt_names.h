// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace telemime::meeting {

/// The number of a run of a participant, drawn at random: 1 to 65535.
std::uint16_t any_session();

/// A client's id, "<who>-" and 8 hexadecimal digits. It is new for each connection: an older one of ours that
/// the broker still holds stays out of the way.
std::string any_client_id(const std::string& who);

}  // namespace telemime::meeting
