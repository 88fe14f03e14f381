// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

namespace telemime::meeting {

/// Members keep their order.
using Json = nlohmann::ordered_json;

/// Levels of nesting that messages may have.
inline constexpr int kDeepestJson = 8;

/// Parses a JSON object from an untrusted source. Returns null when the text is not a JSON object or is
/// nested deeper than `depth`. Never throws.
Json parse_object(std::string_view text, int depth = kDeepestJson);

/// A member of an object; null when it is missing or `object` is not an object.
const Json& member(const Json& object, const char* name);

/// A member that is a string; empty when it is missing or has another type.
std::string text_member(const Json& object, const char* name);

/// A member that is a whole number in [least, most], also one written as 3.0 (JavaScript makes no
/// difference).
std::optional<std::int64_t> whole_member(const Json& object, const char* name, std::int64_t least,
                                         std::int64_t most);

}  // namespace telemime::meeting
