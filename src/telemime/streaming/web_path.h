// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace telemime {

/// The path that a request's target ("/a%20b/./c?x=1") asks for: the query cut off, percent-decoded once, "."
/// and empty segments left out ("/a b/c"; a final slash stays). Nothing for a target that does not start with
/// "/", or is malformed, or not plain after decoding: "..", backslashes, control characters, bytes that are
/// not UTF-8 (over-long forms and surrogates included).
std::optional<std::string> web_path(std::string_view target);

/// The MIME type by the ending of a file's name; "application/octet-stream" when it is unknown.
std::string web_type(std::string_view file_name);

}  // namespace telemime
