// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string_view>

#include "telemime/streaming/web_server.h"

namespace telemime {

/// The file of the page that is built into the program, by the path of its address; "/" is "/index.html".
/// Nothing where there is none.
std::optional<WebContent> page_file(std::string_view path);

/// Whether Vite named the file, "/assets/name-DZaG1Uvn.js": what has this name never changes.
bool has_hash(std::string_view path);

}  // namespace telemime
