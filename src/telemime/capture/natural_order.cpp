// SPDX-License-Identifier: Apache-2.0
#include "telemime/capture/natural_order.h"

#include <cstddef>

namespace telemime {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

std::string_view digits_at(std::string_view text, std::size_t from) {
  std::size_t to = from;
  while (to < text.size() && is_digit(text[to])) {
    ++to;
  }
  return text.substr(from, to - from);
}

std::string_view without_zeros(std::string_view digits) {
  const std::size_t first = digits.find_first_not_of('0');
  return first == std::string_view::npos ? std::string_view{} : digits.substr(first);
}

/// Numbers of any length: the longer one is the larger, equal lengths compare as text.
int compare_numbers(std::string_view a, std::string_view b) {
  const std::string_view x = without_zeros(a);
  const std::string_view y = without_zeros(b);
  if (x.size() != y.size()) {
    return x.size() < y.size() ? -1 : 1;
  }
  return x.compare(y);
}

}  // namespace

bool natural_less(std::string_view a, std::string_view b) {
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (is_digit(a[i]) && is_digit(b[j])) {
      const std::string_view x = digits_at(a, i);
      const std::string_view y = digits_at(b, j);
      const int order = compare_numbers(x, y);
      if (order != 0) {
        return order < 0;
      }
      i += x.size();
      j += y.size();
      continue;
    }
    if (a[i] != b[j]) {
      return static_cast<unsigned char>(a[i]) < static_cast<unsigned char>(b[j]);
    }
    ++i;
    ++j;
  }
  const std::size_t left_a = a.size() - i;
  const std::size_t left_b = b.size() - j;
  if ((left_a == 0) != (left_b == 0)) {
    return left_a == 0;
  }
  return a.size() != b.size() ? a.size() < b.size() : a < b;  // equal except for leading zeros
}

}  // namespace telemime
