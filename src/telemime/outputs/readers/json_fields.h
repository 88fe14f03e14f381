// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "telemime/core/camera.h"

/// Checked access to the members of a JSON object. `where` names the file and the place for the message of
/// the Error(input) that each throws when the member is missing or of another type.
namespace telemime::fields {

/// The JSON value in `text`, or nothing when it is not JSON. Throws Error(input) when it is nested deeper
/// than any file of this project (deep values would overflow the stack when they are copied).
std::optional<nlohmann::json> parse(std::string_view text, const std::string& where);

const nlohmann::json& member(const nlohmann::json& object, const std::string& key, const std::string& where);

/// A finite number.
double number(const nlohmann::json& value, const std::string& where);
double number_at(const nlohmann::json& object, const std::string& key, const std::string& where);
/// `otherwise` when the key is absent or null.
double number_or(const nlohmann::json& object, const std::string& key, double otherwise,
                 const std::string& where);

/// A whole number in [low, high].
std::int64_t integer_at(const nlohmann::json& object, const std::string& key, std::int64_t low,
                        std::int64_t high, const std::string& where);

std::string text_at(const nlohmann::json& object, const std::string& key, const std::string& where);

/// [x, y, z], as it stands.
Eigen::Vector3d vector3(const nlohmann::json& value, const std::string& where);

/// width, height, fx, fy, cx, cy, and `distortion` (5 numbers) when present; sizes and focal lengths
/// positive.
Camera camera(const nlohmann::json& object, const std::string& where);

}  // namespace telemime::fields
