// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace telemime {

/// The path that a request's target ("/a%20b/./c?x=1") asks for: without its query, percent-decoded once,
/// without "." and empty segments ("/a b/c"; a final slash stays). Nothing for a target that does not start
/// with "/", is malformed, or contains "..", backslashes, control characters or invalid UTF-8 (overlong forms
/// and surrogates included) after decoding.
std::optional<std::string> web_path(std::string_view target);

/// The MIME type for the extension of a file name; "application/octet-stream" if it is unknown.
std::string web_type(std::string_view file_name);

}  // namespace telemime
