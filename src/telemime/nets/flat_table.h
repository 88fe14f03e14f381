// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace telemime {

/// A table of a FlatBuffers file. Every access is checked: whatever lies outside the file throws
/// Error(config), so damaged files can be read without a separate verification. Fields are numbered as in the
/// schema, from 0.
class FlatTable {
 public:
  /// The root table of a file. Throws Error(config) unless bytes 4 to 7 are the identifier.
  static FlatTable root(std::span<const std::byte> file, std::string_view identifier);

  /// A scalar field, or `otherwise` if the file leaves it at its default.
  template <class Number>
  Number number(int field, Number otherwise = {}) const {
    const std::size_t at = field_place(field);
    return at == 0 ? otherwise : read<Number>(at);
  }

  /// The elements of a vector of scalars; empty if the field is absent.
  template <class Number>
  std::vector<Number> numbers(int field) const {
    const std::span<const std::byte> raw = bytes(field, sizeof(Number));
    std::vector<Number> values(raw.size() / sizeof(Number));
    if (!raw.empty()) {
      std::memcpy(values.data(), raw.data(), raw.size());
    }
    return values;
  }

  /// The bytes of a vector of scalars of this size; empty if the field is absent.
  std::span<const std::byte> bytes(int field, std::size_t element_size = 1) const;

  std::string text(int field) const;
  std::optional<FlatTable> table(int field) const;
  std::vector<FlatTable> tables(int field) const;

 private:
  FlatTable(std::span<const std::byte> file, std::size_t place);

  template <class Number>
  Number read(std::size_t at) const {
    Number value{};
    std::memcpy(&value, part(at, sizeof(Number)).data(), sizeof(Number));
    return value;
  }
  std::span<const std::byte> part(std::size_t at, std::size_t size) const;
  std::size_t field_place(int field) const;
  std::size_t follow(std::size_t at) const;

  std::span<const std::byte> file_;
  std::size_t place_ = 0;
  std::size_t fields_ = 0;       ///< place of the table of fields
  std::size_t fields_size_ = 0;  ///< bytes
};

}  // namespace telemime
