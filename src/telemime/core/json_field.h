// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "telemime/core/errors.h"

namespace telemime {

struct Camera;

/// What the messages about a JSON text state: its name, the kind of error and the remedy.
struct JsonSource {
  std::string name;
  ErrorKind kind = ErrorKind::input;
  std::string remedy;
  int deepest = 64;  ///< levels of nesting; deep values would overflow the stack when they are copied
};

/// The value of a text. Throws the source's error when the text is not JSON or is nested too deep.
nlohmann::json parse_json(std::string_view text, const JsonSource& source);
/// The same, but nothing when the text is not JSON.
std::optional<nlohmann::json> parse_if_json(std::string_view text, const JsonSource& source);

/// A value of a JSON text, and where it is in the text. Each function checks the value and throws an error
/// that names the source and the place. The value and the source must outlive the field.
class JsonField {
 public:
  /// The whole text.
  JsonField(const nlohmann::json& value, const JsonSource& source)
      : value_(&value), source_(&source), place_(source.name) {}

  /// A member of an object, or the first to the last item of a list.
  JsonField operator[](std::string_view key) const;
  JsonField operator[](std::size_t index) const;
  /// True if this is an object with this member.
  bool has(std::string_view key) const;
  /// What `read` gives for a member of an object; nothing if there is none, or if `read` refuses it.
  template <class Read>
  auto optional(std::string_view key, const Read& read) const -> std::optional<decltype(read(*this))> {
    try {
      return read((*this)[key]);
    } catch (const Error&) {
      return std::nullopt;
    }
  }
  /// The length of a list.
  std::size_t size() const;

  /// A finite number.
  double number() const;
  /// A number in [low, high].
  double number(double low, double high) const;
  /// A finite number greater than 0.
  double positive() const;
  /// A whole number in [low, high], also one written as 3.0.
  std::int64_t integer(std::int64_t low, std::int64_t high) const;
  bool boolean() const;
  /// Checks that this is the text `wanted`.
  void equals(std::string_view wanted) const;
  /// A text of at most `longest` bytes.
  std::string text(std::size_t longest = std::string::npos) const;
  /// A list of exactly as many finite numbers as are asked for.
  template <std::size_t count>
  std::array<double, count> numbers() const {
    if (!value_->is_array() || value_->size() != count) {
      fail("must be a list of " + std::to_string(count) + " numbers");
    }
    std::array<double, count> list{};
    for (std::size_t i = 0; i < count; ++i) {
      list[i] = finite((*value_)[i]);
    }
    return list;
  }

  const nlohmann::json& value() const { return *value_; }
  /// Throws an error "SOURCE: 'KEY' " + what.
  [[noreturn]] void fail(const std::string& what) const;

 private:
  double finite(const nlohmann::json& value) const;

  const nlohmann::json* value_;
  const JsonSource* source_;
  std::string place_;
};

/// What `read` gives for a text that someone else wrote; nothing if it is not JSON, or if `read` refuses it.
template <class Read>
auto read_if_valid(std::string_view text, const JsonSource& source, const Read& read)
    -> std::optional<decltype(read(std::declval<const JsonField&>()))> {
  try {
    const nlohmann::json value = parse_json(text, source);
    return read(JsonField(value, source));
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// The camera in an object: width, height, fx, fy, cx, cy, and `distortion` (5 numbers) when present.
Camera read_camera(const JsonField& object);

}  // namespace telemime
