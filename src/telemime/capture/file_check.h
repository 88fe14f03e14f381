// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "telemime/capture/input_kind.h"
#include "telemime/core/errors.h"

namespace telemime {

/// Error(input) in the one form that all inputs share: "cannot read 'x' as a video file: <cause>".
Error cannot_read(const std::string& input, InputKind kind, const std::string& cause,
                  const std::string& remedy);

/// Throws Error(input) when the file is missing, not a plain file, not readable by this user, or empty.
void require_readable_file(const std::string& path, InputKind kind);

/// True when the file begins like plain text (UTF-8 without control characters). FFmpeg would draw some text
/// files as if they were videos, and follow the links in others.
bool looks_like_text(const std::string& path);

}  // namespace telemime
