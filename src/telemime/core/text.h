// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace telemime {

/// ASCII capitals become small letters; all other bytes stay.
std::string lower_case(std::string_view text);

/// "%41" becomes "A". Returns nothing when a "%" is not followed by two hexadecimal digits.
std::optional<std::string> percent_decoded(std::string_view text);

/// The number of code points of UTF-8 text (RFC 3629). Returns nothing when the bytes are not UTF-8 or
/// contain a control character (U+0000 to U+001F, U+007F to U+009F).
std::optional<std::size_t> printable_length(std::string_view text);

/// The items of a list, converted to text, with ", " between them.
template <class List>
std::string joined(const List& items) {
  std::string text;
  for (const auto& item : items) {
    text.append(text.empty() ? "" : ", ").append(item);
  }
  return text;
}

/// The same of one member of each item: joined(kinds, &SenderKind::example).
template <class List, class Item, class Member>
std::string joined(const List& items, Member Item::*member) {
  std::string text;
  for (const Item& item : items) {
    text.append(text.empty() ? "" : ", ").append(item.*member);
  }
  return text;
}

}  // namespace telemime
