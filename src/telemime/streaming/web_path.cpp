// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/web_path.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

namespace telemime {
namespace {

/// 0 to 15, or -1.
int hex_digit(char c) {
  if (c >= '0' && c <= '9') {
    return c - '0';
  }
  if (c >= 'a' && c <= 'f') {
    return c - 'a' + 10;
  }
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string decoded;
  decoded.reserve(text.size());
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded.push_back(text[i]);
      continue;
    }
    const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1;
    const int low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
    if (high < 0 || low < 0) {
      return std::nullopt;
    }
    decoded.push_back(static_cast<char>(high * 16 + low));
    i += 2;
  }
  return decoded;
}

bool is_control(std::string_view text, std::size_t i) {
  const auto byte = static_cast<unsigned char>(text[i]);
  // The second block of controls, U+0080 to U+009F, is C2 80 to C2 9F.
  return byte < 0x20 || byte == 0x7F ||
         (byte == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0);
}

/// How many bytes a sequence with this lead has, and the range of its second byte: RFC 3629, section 4.
struct Lead {
  std::size_t bytes;
  unsigned char low, high;
};
Lead lead(unsigned char first) {
  if (first < 0x80) {
    return {1, 0, 0};
  }
  if (first < 0xC2 || first > 0xF4) {
    return {0, 0, 0};
  }
  if (first < 0xE0) {
    return {2, 0x80, 0xBF};
  }
  if (first < 0xF0) {
    return {3, static_cast<unsigned char>(first == 0xE0 ? 0xA0 : 0x80),
            static_cast<unsigned char>(first == 0xED ? 0x9F : 0xBF)};
  }
  return {4, static_cast<unsigned char>(first == 0xF0 ? 0x90 : 0x80),
          static_cast<unsigned char>(first == 0xF4 ? 0x8F : 0xBF)};
}

}  // namespace

bool is_utf8(std::string_view bytes) {
  for (std::size_t i = 0; i < bytes.size();) {
    const Lead sequence = lead(static_cast<unsigned char>(bytes[i]));
    if (sequence.bytes == 0 || i + sequence.bytes > bytes.size()) {
      return false;
    }
    for (std::size_t k = 1; k < sequence.bytes; ++k) {
      const auto byte = static_cast<unsigned char>(bytes[i + k]);
      if (byte < (k == 1 ? sequence.low : 0x80) || byte > (k == 1 ? sequence.high : 0xBF)) {
        return false;
      }
    }
    i += sequence.bytes;
  }
  return true;
}

std::optional<std::string> web_path(std::string_view target) {
  if (!target.starts_with('/')) {
    return std::nullopt;
  }
  const std::optional<std::string> decoded = percent_decoded(target.substr(0, target.find_first_of("?#")));
  if (!decoded || !is_utf8(*decoded) || decoded->find("..") != std::string::npos ||
      decoded->find('\\') != std::string::npos) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < decoded->size(); ++i) {
    if (is_control(*decoded, i)) {
      return std::nullopt;
    }
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
