// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace telemime {

/// Opens `url` in the desktop's browser with xdg-open. Does not wait for it; the browser outlives this
/// program. Throws Error(output) if there is no display or no xdg-open.
void open_page(const std::string& url);

}  // namespace telemime
