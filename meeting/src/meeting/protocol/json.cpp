// SPDX-License-Identifier: Apache-2.0
#include "meeting/protocol/json.h"

#include <cmath>

namespace telemime::meeting {

Json parse_object(std::string_view text, int depth) {
  bool too_deep = false;
  const auto shallow = [&](int level, Json::parse_event_t, Json&) {
    too_deep = too_deep || level > depth;
    return !too_deep;
  };
  Json json = Json::parse(text, shallow, /*allow_exceptions=*/false);
  return json.is_object() && !too_deep ? json : Json();
}

const Json& member(const Json& object, const char* name) {
  static const Json none;
  const auto found = object.find(name);
  return found == object.end() ? none : *found;
}

std::string text_member(const Json& object, const char* name) {
  const Json& value = member(object, name);
  return value.is_string() ? value.get<std::string>() : std::string();
}

std::optional<std::int64_t> whole_member(const Json& object, const char* name, std::int64_t least,
                                         std::int64_t most) {
  const Json& value = member(object, name);
  const auto number = value.is_number() ? value.get<double>() : NAN;
  const bool fits = number >= static_cast<double>(least) && number <= static_cast<double>(most) &&
                    number == std::floor(number);
  return fits ? std::optional(static_cast<std::int64_t>(number)) : std::nullopt;
}

}  // namespace telemime::meeting
