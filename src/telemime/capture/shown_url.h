// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace telemime {

/// A stream's URL as it may be shown, kept in files and sent to pages: without "user:password@" and without
/// what stands behind "?", where many cameras want their passwords.
std::string shown_url(const std::string& url);

}  // namespace telemime
