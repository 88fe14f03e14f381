// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace telemime {

struct PageFile {
  std::string_view path;   ///< of its address: "/index.html"
  std::string_view bytes;  ///< for ever
};

/// Every file of the page, sorted by path. Written when the program is built (cmake/TelemimeWeb.cmake).
std::span<const PageFile> page_table();

}  // namespace telemime
