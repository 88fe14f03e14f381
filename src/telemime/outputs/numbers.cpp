// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/numbers.h"

#include <array>
#include <charconv>

#include "telemime/core/errors.h"

namespace telemime {

void append_fixed(std::string& text, double value, int decimals) {
  std::array<char, 400> buffer;  // the longest double has 309 digits before the point
  const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(),
                                          rounded(value, decimals), std::chars_format::fixed, decimals);
  if (error != std::errc()) {
    throw Error(ErrorKind::output, "a number does not fit its field: " + std::to_string(value));
  }
  text.append(buffer.data(), end);
}

std::string padded_count(std::size_t count, std::size_t width) {
  const std::string digits = std::to_string(count);
  if (digits.size() > width) {
    throw Error(ErrorKind::output, "the file cannot hold more than " + std::to_string(count - 1) + " frames",
                "record in parts");
  }
  return digits + std::string(width - digits.size(), ' ');
}

}  // namespace telemime
