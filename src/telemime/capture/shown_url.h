// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace telemime {

/// A stream's URL as it may be shown, kept in files and sent to pages: without "user:password@", and without
/// what stands behind "?" or in the path from the first "name=value" on, where many cameras want their
/// passwords. What is no URL stays as it is.
std::string shown_url(const std::string& url);

}  // namespace telemime
