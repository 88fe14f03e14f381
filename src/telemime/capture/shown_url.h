// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace telemime {

/// The URL of a stream without secrets, for display, files and pages: without "user:password@", and without
/// the query or the path from the first "name=value" on, where many cameras expect their passwords. Other
/// text is returned unchanged.
std::string shown_url(const std::string& url);

}  // namespace telemime
