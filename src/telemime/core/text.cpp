// SPDX-License-Identifier: Apache-2.0
#include "telemime/core/text.h"

#include <utf8.h>

#include <algorithm>
#include <charconv>

namespace telemime {

std::string lower_case(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return result;
}

std::optional<std::string> percent_decoded(std::string_view text) {
  std::string decoded;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      decoded += text[i];
      continue;
    }
    unsigned byte = 0;
    const std::string_view digits = text.substr(i + 1, 2);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), byte, 16);
    if (digits.size() != 2 || error != std::errc() || end != digits.data() + 2) {
      return std::nullopt;
    }
    decoded += static_cast<char>(byte);
    i += 2;
  }
  return decoded;
}

std::optional<std::size_t> printable_length(std::string_view text) {
  if (!utf8::is_valid(text.begin(), text.end())) {
    return std::nullopt;
  }
  std::size_t length = 0;
  for (auto at = text.begin(); at != text.end(); ++length) {
    const std::uint32_t point = utf8::unchecked::next(at);
    if (point < 0x20 || (point >= 0x7F && point < 0xA0)) {
      return std::nullopt;
    }
  }
  return length;
}

}  // namespace telemime
