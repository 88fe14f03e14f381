// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_path.h"

#include <algorithm>
#include <array>
#include <utility>

#include "telemime/core/text.h"

namespace telemime {

std::optional<std::string> web_path(std::string_view target) {
  if (!target.starts_with('/')) {
    return std::nullopt;
  }
  const std::optional<std::string> decoded = percent_decoded(target.substr(0, target.find_first_of("?#")));
  if (!decoded || !printable_length(*decoded) || decoded->find("..") != std::string::npos ||
      decoded->find('\\') != std::string::npos) {
    return std::nullopt;
  }
  std::string path;
  std::string_view rest = *decoded;
  while (!rest.empty()) {
    rest.remove_prefix(1);  // the slash
    const std::string_view segment = rest.substr(0, rest.find('/'));
    rest.remove_prefix(segment.size());
    if (!segment.empty() && segment != ".") {
      path.append("/").append(segment);
    }
  }
  if (path.empty() || decoded->ends_with('/')) {
    path.push_back('/');
  }
  return path;
}

std::string web_type(std::string_view file_name) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 24> types = {{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".map", "application/json"},
      {".webmanifest", "application/manifest+json"},
      {".txt", "text/plain; charset=utf-8"},
      {".bvh", "text/plain; charset=utf-8"},
      {".trc", "text/plain; charset=utf-8"},
      {".csv", "text/csv; charset=utf-8"},
      {".jsonl", "application/x-ndjson"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
      {".jpeg", "image/jpeg"},
      {".webp", "image/webp"},
      {".ico", "image/x-icon"},
      {".woff2", "font/woff2"},
      {".wasm", "application/wasm"},
      {".glb", "model/gltf-binary"},
      {".vrm", "model/gltf-binary"},
      {".vrma", "model/gltf-binary"},
      {".gltf", "model/gltf+json"},
  }};
  const auto* found = std::find_if(types.begin(), types.end(),
                                   [&](const auto& type) { return file_name.ends_with(type.first); });
  return std::string(found == types.end() ? "application/octet-stream" : found->second);
}

}  // namespace telemime
