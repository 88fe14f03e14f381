// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace telemime::meeting {

/// Bytes of the system's random numbers that nobody can guess. Throws Error(output) where there are none.
std::string random_bytes(std::size_t count);

/// RFC 4648: base64 with its padding, and base64url without.
std::string base64(std::string_view bytes);
std::string base64url(std::string_view bytes);

/// A secret of 192 random bits as 32 characters that fit into addresses.
std::string random_secret();

/// HMAC-SHA-256 of the text as base64url (43 characters).
std::string signature(std::string_view key, std::string_view text);

/// Whether the two are the same, in a time that does not tell how much of them is.
bool same_secret(std::string_view a, std::string_view b);

}  // namespace telemime::meeting
