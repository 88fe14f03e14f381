// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/filter_model.h"

#include <cmath>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "telemime/core/errors.h"

namespace telemime {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMillimetre = 1e-3;
constexpr const char* kDefault =
#include "filter_model.inc"
    ;

// Unit of a pose number in the file: mm for the root's position, degrees for angles.
double unit_of(std::size_t index) {
  return index < 3 ? kMillimetre : kDegree;
}

std::string name_of(std::size_t index) {
  constexpr std::array<const char*, 3> kRoot = {"root_x", "root_y", "root_z"};
  return index < 3 ? kRoot[index] : std::string(kAngleNames[index - 3]);
}

double positive(const Json& json, const std::string& key, const std::string& name) {
  if (!json.contains(key) || !json[key].is_number() || !std::isfinite(json[key].get<double>()) ||
      json[key].get<double>() <= 0.0) {
    throw Error(ErrorKind::config, name + ": '" + key + "' must be a number above 0",
                "`telemime-lab learn` writes such files.");
  }
  return json[key].get<double>();
}

}  // namespace

FilterModel default_filter_model() {
  return load_filter_model("");
}

FilterModel parse_filter_model(const std::string& text, const std::string& name, const CueTable& cues) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("format") || json["format"] != "telemime-filter") {
    throw Error(ErrorKind::config, name + " is not a filter model",
                "It must be a JSON object with \"format\": \"telemime-filter\".");
  }
  const Json none = Json::object();
  const auto group = [&](const char* key) -> const Json& { return json.contains(key) ? json[key] : none; };
  FilterModel model;
  for (std::size_t i = 0; i < cues.size(); ++i) {
    const std::string key(cues[i].sigma_key);
    model.sigma[i] = key.empty() ? cues[i].sigma : positive(json, key, name);
  }
  for (std::size_t i = 0; i < kPoseSize; ++i) {
    model.change[static_cast<Eigen::Index>(i)] = positive(group("change"), name_of(i), name) * unit_of(i);
  }
  for (std::size_t i = 0; i < kPartCount; ++i) {
    model.motion[i] = positive(group("motion"), std::string(kPartNames[i]), name);
  }
  const Json& wrist = group("end_effector");
  model.wrist_across = positive(wrist, "wrist_across_mm", name) * kMillimetre;
  model.wrist_along = positive(wrist, "wrist_along_mm", name) * kMillimetre;
  model.swivel = positive(wrist, "swivel_degrees", name) * kDegree;
  const Json& spread = group("spread");
  model.spread.trunk = positive(spread, "trunk_mm", name) * kMillimetre;
  model.spread.lean = positive(spread, "lean", name);
  model.spread.slide = positive(spread, "slide_mm", name) * kMillimetre;
  model.spread.across = positive(spread, "across", name);
  model.spread.seen = positive(spread, "seen", name);
  model.spread.residual = positive(spread, "residual", name);
  model.spread.size = positive(spread, "size", name);
  model.spread.size_given = positive(spread, "size_given", name);
  return model;
}

FilterModel load_filter_model(const std::string& file, const CueTable& cues) {
  if (file.empty()) {
    return parse_filter_model(kDefault, "data/filter.json", cues);
  }
  std::ifstream in(file);
  if (!in || std::filesystem::is_directory(file)) {
    throw Error(ErrorKind::config, "the filter model " + file + " cannot be opened",
                "Check the path and its permissions.");
  }
  return parse_filter_model(std::string(std::istreambuf_iterator<char>(in), {}), file, cues);
}

std::string to_json_text(const FilterModel& model, const std::string& note) {
  // The estimates are not more precise than four digits.
  const auto digits = [](double value) {
    std::ostringstream text;
    text << std::setprecision(4) << value;
    return std::stod(text.str());
  };
  Json json = {{"format", "telemime-filter"}, {"note", note}};
  for (std::size_t i = 0; i < kCues.size(); ++i) {
    if (!kCues[i].sigma_key.empty()) {
      json[std::string(kCues[i].sigma_key)] = digits(model.sigma[i]);
    }
  }
  for (std::size_t i = 0; i < kPoseSize; ++i) {
    json["change"][name_of(i)] = digits(model.change[static_cast<Eigen::Index>(i)] / unit_of(i));
  }
  for (std::size_t i = 0; i < kPartCount; ++i) {
    json["motion"][std::string(kPartNames[i])] = digits(model.motion[i]);
  }
  json["end_effector"] = {{"wrist_across_mm", digits(model.wrist_across / kMillimetre)},
                          {"wrist_along_mm", digits(model.wrist_along / kMillimetre)},
                          {"swivel_degrees", digits(model.swivel / kDegree)}};
  json["spread"] = {{"trunk_mm", digits(model.spread.trunk / kMillimetre)},
                    {"lean", digits(model.spread.lean)},
                    {"across", digits(model.spread.across)},
                    {"slide_mm", digits(model.spread.slide / kMillimetre)},
                    {"seen", digits(model.spread.seen)},
                    {"residual", digits(model.spread.residual)},
                    {"size", digits(model.spread.size)},
                    {"size_given", digits(model.spread.size_given)}};
  return json.dump(2) + "\n";
}

}  // namespace telemime
