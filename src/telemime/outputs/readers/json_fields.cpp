// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/readers/json_fields.h"

#include <cmath>

#include "telemime/core/errors.h"

namespace telemime::fields {
namespace {

constexpr int kLargestImageSide = 100000;
constexpr int kDeepestNesting = 64;

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw Error(ErrorKind::input, where + ": " + what,
              "is it the right file, and was it written completely? docs/formats.md describes the formats");
}

std::string quoted(const std::string& key) {
  return std::string("\"").append(key).append("\"");
}

double positive(const nlohmann::json& object, const std::string& key, const std::string& where) {
  const double value = number_at(object, key, where);
  if (!(value > 0.0)) {
    fail(where, quoted(key) + " must be greater than 0");
  }
  return value;
}

}  // namespace

std::optional<nlohmann::json> parse(std::string_view text, const std::string& where) {
  const auto shallow = [&where](int depth, nlohmann::json::parse_event_t, const nlohmann::json&) {
    if (depth > kDeepestNesting) {
      fail(where, "nested more than " + std::to_string(kDeepestNesting) + " levels deep");
    }
    return true;
  };
  nlohmann::json value = nlohmann::json::parse(text, shallow, /*allow_exceptions=*/false);
  if (value.is_discarded()) {
    return std::nullopt;
  }
  return value;
}

const nlohmann::json& member(const nlohmann::json& object, const std::string& key, const std::string& where) {
  if (!object.is_object()) {
    fail(where, "a JSON object with " + quoted(key) + " was expected");
  }
  const auto found = object.find(key);
  if (found == object.end()) {
    fail(where, quoted(key) + " is missing");
  }
  return *found;
}

double number(const nlohmann::json& value, const std::string& where) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) {
    fail(where, "a finite number was expected");
  }
  return value.get<double>();
}

double number_at(const nlohmann::json& object, const std::string& key, const std::string& where) {
  return number(member(object, key, where), where + ": " + quoted(key));
}

double number_or(const nlohmann::json& object, const std::string& key, double otherwise,
                 const std::string& where) {
  if (!object.is_object() || !object.contains(key) || object.at(key).is_null()) {
    return otherwise;
  }
  return number_at(object, key, where);
}

std::int64_t integer_at(const nlohmann::json& object, const std::string& key, std::int64_t low,
                        std::int64_t high, const std::string& where) {
  const nlohmann::json& value = member(object, key, where);
  const std::string range = "[" + std::to_string(low) + ", " + std::to_string(high) + "]";
  const bool fits = value.is_number_integer() &&
                    !(value.is_number_unsigned() && value.get<std::uint64_t>() > std::uint64_t{INT64_MAX});
  if (!fits || value.get<std::int64_t>() < low || value.get<std::int64_t>() > high) {
    fail(where, quoted(key) + " must be a whole number in " + range);
  }
  return value.get<std::int64_t>();
}

std::string text_at(const nlohmann::json& object, const std::string& key, const std::string& where) {
  const nlohmann::json& value = member(object, key, where);
  if (!value.is_string()) {
    fail(where, quoted(key) + " must be text");
  }
  return value.get<std::string>();
}

Eigen::Vector3d vector3(const nlohmann::json& value, const std::string& where) {
  if (!value.is_array() || value.size() != 3) {
    fail(where, "[x, y, z] was expected");
  }
  return {number(value[0], where), number(value[1], where), number(value[2], where)};
}

Camera camera(const nlohmann::json& object, const std::string& where) {
  Camera camera;
  camera.width = static_cast<int>(integer_at(object, "width", 1, kLargestImageSide, where));
  camera.height = static_cast<int>(integer_at(object, "height", 1, kLargestImageSide, where));
  camera.fx = positive(object, "fx", where);
  camera.fy = positive(object, "fy", where);
  camera.cx = number_at(object, "cx", where);
  camera.cy = number_at(object, "cy", where);
  if (object.contains("distortion")) {
    const nlohmann::json& list = object.at("distortion");
    if (!list.is_array() || list.size() != camera.distortion.size()) {
      fail(where, "\"distortion\" must be 5 numbers k1 k2 p1 p2 k3");
    }
    for (std::size_t i = 0; i < camera.distortion.size(); ++i) {
      camera.distortion[i] = number(list[i], where + ": \"distortion\"");
    }
  }
  return camera;
}

}  // namespace telemime::fields
