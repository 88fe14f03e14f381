// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace telemime {

/// Has the desktop's browser show `url`, by xdg-open. Does not wait for it; the browser outlives this
/// program. Throws Error(output) when there is no display, or no xdg-open.
void open_page(const std::string& url);

}  // namespace telemime
