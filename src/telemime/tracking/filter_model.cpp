// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/filter_model.h"

#include <iomanip>
#include <numbers>
#include <sstream>

#include "telemime/core/files.h"
#include "telemime/core/json_field.h"

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

}  // namespace

FilterModel parse_filter_model(const std::string& text, const std::string& name, const CueTable& cues) {
  const JsonSource source{name, ErrorKind::config, "`telemime-lab learn` writes such files."};
  const auto json = parse_json(text, source);
  const JsonField root(json, source);
  root["format"].equals("telemime-filter");
  FilterModel model;
  for (std::size_t i = 0; i < cues.size(); ++i) {
    model.sigma[i] = cues[i].sigma_key.empty() ? cues[i].sigma : root[cues[i].sigma_key].positive();
  }
  for (std::size_t i = 0; i < kPoseSize; ++i) {
    model.change[static_cast<Eigen::Index>(i)] = root["change"][name_of(i)].positive() * unit_of(i);
  }
  for (std::size_t i = 0; i < kPartCount; ++i) {
    model.motion[i] = root["motion"][kPartNames[i]].positive();
  }
  const JsonField wrist = root["end_effector"];
  model.wrist_across = wrist["wrist_across_mm"].positive() * kMillimetre;
  model.wrist_along = wrist["wrist_along_mm"].positive() * kMillimetre;
  model.swivel = wrist["swivel_degrees"].positive() * kDegree;
  const JsonField spread = root["spread"];
  model.spread.trunk = spread["trunk_mm"].positive() * kMillimetre;
  model.spread.lean = spread["lean"].positive();
  model.spread.slide = spread["slide_mm"].positive() * kMillimetre;
  model.spread.across = spread["across"].positive();
  model.spread.seen = spread["seen"].positive();
  model.spread.residual = spread["residual"].positive();
  model.usual[cue::kRegion] = model.spread.residual;
  model.spread.size = spread["size"].positive();
  model.spread.size_given = spread["size_given"].positive();
  return model;
}

FilterModel load_filter_model(const std::string& file, const CueTable& cues) {
  return file.empty() ? parse_filter_model(kDefault, "data/filter.json", cues)
                      : parse_filter_model(read_text_file(file, ErrorKind::config), file, cues);
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
