// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/limits.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

using Range = std::array<double, 2>;

constexpr double kDegree = std::numbers::pi / 180.0;

// In the order of Angle. The right side mirrors the left: ranges about y and z change sign and ends.
constexpr std::array<Range, kAngleCount> kReference = {{
    {-180, 180}, {-45, 45},   {-45, 45},  {-10, 10}, {-10, 10},   {-10, 10}, {-110, 25},
    {-60, 30},   {-20, 100},  {-110, 25}, {-30, 60}, {-100, 20},  {-150, 0}, {-150, 0},
    {-20, 20},   {-100, 100}, {-37, 27},  {-20, 20}, {-100, 100}, {-37, 27},
}};

constexpr std::array<Range, kAngleCount> kAnatomical = {{
    {-180, 180}, {-45, 45},  {-30, 60},  {-45, 45}, {-80, 80},  {-45, 45}, {-180, 60},
    {-90, 90},   {-45, 180}, {-180, 60}, {-90, 90}, {-180, 45}, {-150, 5}, {-150, 5},
    {-70, 70},   {-90, 90},  {-30, 20},  {-70, 70}, {-90, 90},  {-30, 20},
}};

JointLimits from_degrees(const std::string& name, const std::array<Range, kAngleCount>& table) {
  JointLimits limits;
  limits.name = name;
  for (std::size_t i = 0; i < kAngleCount; ++i) {
    limits.min[i] = table[i][0] * kDegree;
    limits.max[i] = table[i][1] * kDegree;
  }
  return limits;
}

}  // namespace

bool JointLimits::contains(const Pose& pose, double tolerance) const {
  for (std::size_t i = 0; i < kAngleCount; ++i) {
    if (!(pose.angles[i] >= min[i] - tolerance && pose.angles[i] <= max[i] + tolerance)) {
      return false;
    }
  }
  return true;
}

Pose JointLimits::clamp(const Pose& pose) const {
  Pose inside = pose;
  for (std::size_t i = 0; i < kAngleCount; ++i) {
    inside.angles[i] = std::clamp(pose.angles[i], min[i], max[i]);
  }
  return inside;
}

JointLimits reference_limits() {
  return from_degrees("reference", kReference);
}

JointLimits anatomical_limits() {
  return from_degrees("anatomical", kAnatomical);
}

JointLimits load_limits(const std::string& name_or_file) {
  if (name_or_file == "reference") {
    return reference_limits();
  }
  if (name_or_file == "anatomical") {
    return anatomical_limits();
  }
  const auto fail = [&](const std::string& why) -> Error {
    return {ErrorKind::config, "joint limits " + name_or_file + ": " + why,
            "Use 'reference', 'anatomical' or a JSON file with all 20 angles in degrees "
            "(docs/configuration.md)."};
  };
  std::ifstream in(name_or_file);
  if (!in) {
    throw fail("no such file and no set of that name");
  }
  if (std::filesystem::is_directory(name_or_file)) {
    throw fail("that is a folder");
  }
  const auto json = nlohmann::json::parse(in, nullptr, false);
  if (!json.is_object() || !json.contains("limits") || !json["limits"].is_object()) {
    throw fail("it is not JSON with an object 'limits'");
  }
  for (const auto& [key, value] : json["limits"].items()) {
    if (std::find(kAngleNames.begin(), kAngleNames.end(), key) == kAngleNames.end()) {
      throw fail("unknown angle '" + key + "'");
    }
  }
  JointLimits limits;
  limits.name =
      json.contains("name") && json["name"].is_string() ? json["name"].get<std::string>() : name_or_file;
  for (std::size_t i = 0; i < kAngleCount; ++i) {
    const std::string name(kAngleNames[i]);
    const auto& range = json["limits"].value(name, nlohmann::json());
    if (!range.is_array() || range.size() != 2 || !range[0].is_number() || !range[1].is_number()) {
      throw fail("'" + name + "' is not [min, max]");
    }
    limits.min[i] = range[0].get<double>() * kDegree;
    limits.max[i] = range[1].get<double>() * kDegree;
    if (!(limits.min[i] <= limits.max[i]) || std::abs(limits.min[i]) > 7.0 || std::abs(limits.max[i]) > 7.0) {
      throw fail("'" + name + "' must have min <= max, both within 360 degrees");
    }
  }
  return limits;
}

}  // namespace telemime
