// SPDX-License-Identifier: Apache-2.0
#include "telemime/evaluation/truth.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "telemime/core/errors.h"
#include "telemime/outputs/numbers.h"
#include "telemime/outputs/readers/json_fields.h"
#include "telemime/outputs/readers/text_file.h"

namespace telemime {
namespace {

using nlohmann::json;

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw Error(ErrorKind::input, where + ": " + what, "docs/evaluation.md describes truth.json");
}

const json& array_at(const json& object, const std::string& key, const std::string& where) {
  const json& value = fields::member(object, key, where);
  if (!value.is_array()) {
    fail(where, "\"" + key + "\" must be a list");
  }
  return value;
}

/// For each column of the file the joint that it holds, or nothing for one that telemime does not have.
std::vector<std::optional<std::size_t>> joint_columns(const json& root, const std::string& where) {
  std::vector<std::optional<std::size_t>> columns;
  for (const json& name : array_at(root, "joints", where)) {
    if (!name.is_string()) {
      fail(where, "\"joints\" must be a list of names");
    }
    const auto* const found =
        std::find(kJointNames.begin(), kJointNames.end(), name.get_ref<const std::string&>());
    columns.push_back(found == kJointNames.end() ? std::nullopt
                                                 : std::optional<std::size_t>(static_cast<std::size_t>(
                                                       found - kJointNames.begin())));
  }
  return columns;
}

/// true, false, 1 or 0.
bool flag(const json& value, const std::string& where) {
  if (value.is_boolean()) {
    return value.get<bool>();
  }
  return fields::number(value, where) != 0.0;
}

/// One frame; `valid` is null when the file has no such flags.
TruthJoints read_joints(const json& positions, const json& valid,
                        const std::vector<std::optional<std::size_t>>& columns, const std::string& where) {
  TruthJoints joints;
  if (positions.is_null()) {
    return joints;
  }
  if (!positions.is_array() || positions.size() != columns.size() ||
      (!valid.is_null() && (!valid.is_array() || valid.size() != columns.size()))) {
    fail(where, "one position (and flag) for each of \"joints\" was expected");
  }
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const json& position = positions[c];
    const bool known =
        !position.is_null() && !(position.is_array() && !position.empty() && position[0].is_null());
    if (columns[c] && known && (valid.is_null() || flag(valid[c], where))) {
      joints[*columns[c]] = fields::vector3(position, where) / kMillimetresPerMetre;
    }
  }
  return joints;
}

void read_range(const json& root, const std::string& where, Truth& truth) {
  truth.last_scored = truth.frames.size() - 1;
  if (!root.contains("best_frames")) {
    return;
  }
  const json& range = root.at("best_frames");
  if (!range.is_array() || range.size() != 2 || !range[0].is_number_unsigned() ||
      !range[1].is_number_unsigned() || range[0].get<std::uint64_t>() > range[1].get<std::uint64_t>()) {
    fail(where, "\"best_frames\" must be [first, last]");
  }
  truth.first_scored = range[0].get<std::uint64_t>();
  truth.last_scored = std::min<std::size_t>(range[1].get<std::uint64_t>(), truth.last_scored);
}

}  // namespace

Truth parse_truth(std::string_view text, const std::string& name) {
  const std::optional<json> root = fields::parse(text, name);
  if (!root) {
    fail(name, "not JSON");
  }
  Truth truth;
  truth.name = name;
  truth.camera = fields::camera(*root, name);
  truth.fps = fields::number_or(*root, "fps", truth.fps, name);
  if (!(truth.fps > 0.0)) {
    fail(name, "\"fps\" must be greater than 0");
  }
  truth.scale_known = !root->contains("scale") || root->at("scale").is_number();
  const auto columns = joint_columns(*root, name);
  const json& positions = array_at(*root, "positions", name);
  const json nothing;
  const json& valid = root->contains("valid") ? array_at(*root, "valid", name) : nothing;
  if (positions.empty() || (!valid.is_null() && valid.size() != positions.size())) {
    fail(name, "\"positions\" (and \"valid\") must have one entry for each frame");
  }
  for (std::size_t f = 0; f < positions.size(); ++f) {
    truth.frames.push_back(read_joints(positions[f], valid.is_null() ? nothing : valid[f], columns,
                                       name + ", frame " + std::to_string(f)));
  }
  if (root->contains("visible")) {
    const json& visible = array_at(*root, "visible", name);
    if (visible.size() != positions.size()) {
      fail(name, "\"visible\" must have one entry for each frame");
    }
    for (const json& value : visible) {
      truth.visible.push_back(flag(value, name + ": \"visible\""));
    }
  }
  read_range(*root, name, truth);
  return truth;
}

Truth read_truth(const std::filesystem::path& file) {
  return parse_truth(read_text_file(file), file.string());
}

}  // namespace telemime
