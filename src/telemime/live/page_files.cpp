// SPDX-License-Identifier: Apache-2.0
#include "telemime/live/page_files.h"

#include <memory>
#include <string>

#include "telemime/live/page_table.h"
#include "telemime/streaming/web_path.h"

namespace telemime {

bool has_hash(std::string_view path) {
  constexpr std::size_t hash_length = 8;
  constexpr std::string_view folder = "/assets/";
  const std::string_view name = path.substr(path.rfind('/') + 1);
  const std::string_view stem = name.substr(0, name.rfind('.'));
  return path.starts_with(folder) && stem.size() > hash_length + 1 && stem.size() < name.size() &&
         stem[stem.size() - hash_length - 1] == '-';
}

std::optional<WebContent> page_file(std::string_view path) {
  const std::string_view wanted = path == "/" ? "/index.html" : path;
  for (const PageFile& file : page_table()) {
    if (file.path == wanted) {
      return WebContent{std::make_shared<const std::string>(file.bytes), web_type(wanted), "",
                        has_hash(wanted)};
    }
  }
  return std::nullopt;
}

}  // namespace telemime
