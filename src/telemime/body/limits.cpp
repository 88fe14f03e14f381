// SPDX-License-Identifier: Apache-2.0
#include "telemime/body/limits.h"

#include <algorithm>
#include <numbers>

#include "telemime/core/files.h"
#include "telemime/core/json_field.h"

namespace telemime {
namespace {

using AngleRange = std::array<double, 2>;

constexpr double kDegree = std::numbers::pi / 180.0;

// In the order of Angle. The right side mirrors the left: ranges about y and z change sign and ends.
constexpr std::array<AngleRange, kAngleCount> kReference = {{
    {-180, 180}, {-45, 45},   {-45, 45},  {-10, 10}, {-10, 10},   {-10, 10}, {-110, 25},
    {-60, 30},   {-20, 100},  {-110, 25}, {-30, 60}, {-100, 20},  {-150, 0}, {-150, 0},
    {-20, 20},   {-100, 100}, {-37, 27},  {-20, 20}, {-100, 100}, {-37, 27},
}};

constexpr std::array<AngleRange, kAngleCount> kAnatomical = {{
    {-180, 180}, {-45, 45},  {-30, 60},  {-45, 45}, {-80, 80},  {-45, 45}, {-180, 60},
    {-90, 90},   {-45, 180}, {-180, 60}, {-90, 90}, {-180, 45}, {-150, 5}, {-150, 5},
    {-70, 70},   {-90, 90},  {-30, 20},  {-70, 70}, {-90, 90},  {-30, 20},
}};

JointLimits from_degrees(const std::string& name, const std::array<AngleRange, kAngleCount>& table) {
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
  const JsonSource source{"joint limits " + name_or_file, ErrorKind::config,
                          "Use 'reference', 'anatomical' or a JSON file with an object 'limits' of all 20 "
                          "angles in degrees (docs/configuration.md)."};
  std::error_code ignored;
  if (!std::filesystem::exists(name_or_file, ignored)) {
    throw Error(source.kind, source.name + ": no such file and no set of that name", source.remedy);
  }
  const auto json = parse_json(read_text_file(name_or_file, source.kind), source);
  const JsonField root(json, source);
  const JsonField ranges = root["limits"];
  JointLimits limits;
  limits.name = root.has("name") ? root["name"].text() : name_or_file;
  for (std::size_t i = 0; i < kAngleCount; ++i) {
    const JsonField field = ranges[kAngleNames[i]];
    const auto [min, max] = field.numbers<2>();
    if (!(min <= max) || min < -360.0 || max > 360.0) {
      field.fail("must have min <= max, both within 360 degrees");
    }
    limits.min[i] = min * kDegree;
    limits.max[i] = max * kDegree;
  }
  for (const auto& [key, value] : ranges.value().items()) {
    if (std::find(kAngleNames.begin(), kAngleNames.end(), key) == kAngleNames.end()) {
      ranges.fail("has the unknown angle '" + key + "'");
    }
  }
  return limits;
}

}  // namespace telemime
