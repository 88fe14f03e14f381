// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <utility>
#include <variant>

#include "telemime/core/json_field.h"

namespace telemime::meeting {

/// JSON that others write: nested at most 8 levels deep.
inline const JsonSource kMessageSource{
    .name = "the message", .kind = ErrorKind::input, .remedy = "", .deepest = 8};

/// The result of reading bytes from an untrusted source: a value, or the reason why there is none. Malformed
/// input is expected, so it is not an exception.
template <class Value, class Fault>
class Outcome {
 public:
  Outcome(Value value) : content_(std::in_place_index<0>, std::move(value)) {}
  Outcome(Fault fault) : content_(std::in_place_index<1>, std::move(fault)) {}

  explicit operator bool() const { return content_.index() == 0; }
  /// The value; requires that there is one.
  const Value& operator*() const { return std::get<0>(content_); }
  const Value* operator->() const { return &std::get<0>(content_); }
  /// The reason; requires that there is no value.
  const Fault& fault() const { return std::get<1>(content_); }

 private:
  std::variant<Value, Fault> content_;
};

}  // namespace telemime::meeting
