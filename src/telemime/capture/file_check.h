// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "telemime/capture/input_kind.h"
#include "telemime/core/errors.h"

namespace telemime {

/// An Error(input) of the form "cannot read 'x' as a video file: <cause>", for all kinds of input.
Error cannot_read(const std::string& input, InputKind kind, const std::string& cause,
                  const std::string& remedy);

/// Throws Error(input) if the file is missing, not a regular file, not readable by this user, or empty.
void require_readable_file(const std::string& path, InputKind kind);

/// Whether the file begins like plain text (UTF-8 without control characters). FFmpeg would render some text
/// files as videos and follow the links in others.
bool looks_like_text(const std::string& path);

}  // namespace telemime
