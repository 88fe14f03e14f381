// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace telemime::meeting {

/// Cryptographically secure random bytes. Throws Error(output) when there are none.
std::string random_bytes(std::size_t count);

/// RFC 4648: base64 with padding, base64url without.
std::string base64(std::string_view bytes);
std::string base64url(std::string_view bytes);

/// A secret of 192 random bits, 32 characters that are valid in URLs.
std::string random_secret();

/// HMAC-SHA-256 of the text as base64url (43 characters).
std::string signature(std::string_view key, std::string_view text);

/// Whether two secrets are equal, in constant time.
bool same_secret(std::string_view a, std::string_view b);

}  // namespace telemime::meeting
