// SPDX-License-Identifier: Apache-2.0
#include "telemime/evaluation/truth.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "telemime/core/files.h"
#include "telemime/core/json_field.h"
#include "telemime/outputs/numbers.h"

namespace telemime {
namespace {

using nlohmann::json;

/// For each column of the file the joint that it holds, or nothing for one that telemime does not have.
std::vector<std::optional<std::size_t>> joint_columns(const JsonField& names) {
  std::vector<std::optional<std::size_t>> columns;
  for (std::size_t c = 0; c < names.size(); ++c) {
    const auto* const found = std::find(kJointNames.begin(), kJointNames.end(), names[c].text());
    columns.push_back(found == kJointNames.end() ? std::nullopt
                                                 : std::optional<std::size_t>(static_cast<std::size_t>(
                                                       found - kJointNames.begin())));
  }
  return columns;
}

/// true, false, 1 or 0.
bool flag(const JsonField& field) {
  return field.value().is_boolean() ? field.boolean() : field.number() != 0.0;
}

void check_size(const JsonField& list, std::size_t size, const std::string& what) {
  if (list.size() != size) {
    list.fail("must have one entry for each " + what);
  }
}

/// One frame; `valid` is absent when the file has no such flags.
TruthJoints read_joints(const JsonField& positions, const std::optional<JsonField>& valid,
                        const std::vector<std::optional<std::size_t>>& columns) {
  TruthJoints joints;
  if (positions.value().is_null()) {
    return joints;
  }
  check_size(positions, columns.size(), "of \"joints\"");
  if (valid) {
    check_size(*valid, columns.size(), "of \"joints\"");
  }
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const json& position = positions.value()[c];
    const bool known =
        !position.is_null() && !(position.is_array() && !position.empty() && position[0].is_null());
    if (columns[c] && known && (!valid || flag((*valid)[c]))) {
      const auto [x, y, z] = positions[c].numbers<3>();
      joints[*columns[c]] = Eigen::Vector3d(x, y, z) / kMillimetresPerMetre;
    }
  }
  return joints;
}

// The hands of one frame; null where they are not known.
std::optional<HandPoints> read_hand(const JsonField& points) {
  if (points.value().is_null()) {
    return std::nullopt;
  }
  check_size(points, kHandJointCount, "joint of a hand");
  HandPoints hand;
  for (std::size_t j = 0; j < kHandJointCount; ++j) {
    const auto [x, y, z] = points[j].numbers<3>();
    hand[j] = Eigen::Vector3d(x, y, z) / kMillimetresPerMetre;
  }
  return hand;
}

// The head of one frame; null where it is not known.
std::optional<Eigen::Quaterniond> read_head(const JsonField& rotation) {
  if (rotation.value().is_null()) {
    return std::nullopt;
  }
  const auto [x, y, z, w] = rotation.numbers<4>();
  const Eigen::Quaterniond head(w, x, y, z);
  constexpr double kRounding = 0.01;
  if (!(std::abs(head.norm() - 1.0) <= kRounding)) {
    rotation.fail("must be a unit quaternion");
  }
  return head.normalized();
}

void read_range(const JsonField& root, Truth& truth) {
  truth.last_scored = truth.frames.size() - 1;
  if (!root.has("best_frames")) {
    return;
  }
  const JsonField range = root["best_frames"];
  check_size(range, 2, "end: [first, last]");
  truth.first_scored = static_cast<std::size_t>(range[0].integer(0, INT64_MAX));
  const auto last = static_cast<std::size_t>(range[1].integer(range[0].integer(0, INT64_MAX), INT64_MAX));
  truth.last_scored = std::min(last, truth.last_scored);
}

}  // namespace

Truth parse_truth(std::string_view text, const std::string& name) {
  const JsonSource source{name, ErrorKind::input, "docs/evaluation.md describes truth.json"};
  const json parsed = parse_json(text, source);
  const JsonField root(parsed, source);
  Truth truth;
  truth.name = name;
  truth.camera = read_camera(root);
  if (root.has("fps") && !root["fps"].value().is_null()) {
    truth.fps = root["fps"].positive();
  }
  truth.scale_known = !root.has("scale") || root["scale"].value().is_number();
  const auto columns = joint_columns(root["joints"]);
  const JsonField positions = root["positions"];
  if (positions.size() == 0) {
    positions.fail("must have one entry for each frame");
  }
  const auto valid = root.has("valid") ? std::optional(root["valid"]) : std::nullopt;
  if (valid) {
    check_size(*valid, positions.size(), "frame");
  }
  for (std::size_t f = 0; f < positions.size(); ++f) {
    truth.frames.push_back(
        read_joints(positions[f], valid ? std::optional((*valid)[f]) : std::nullopt, columns));
  }
  if (root.has("hands")) {
    const JsonField left = root["hands"]["left"];
    const JsonField right = root["hands"]["right"];
    check_size(left, positions.size(), "frame");
    check_size(right, positions.size(), "frame");
    for (std::size_t f = 0; f < positions.size(); ++f) {
      truth.hands.push_back({read_hand(left[f]), read_hand(right[f])});
    }
  }
  if (root.has("head")) {
    const JsonField heads = root["head"];
    check_size(heads, positions.size(), "frame");
    for (std::size_t f = 0; f < heads.size(); ++f) {
      truth.heads.push_back(read_head(heads[f]));
    }
  }
  if (root.has("visible")) {
    const JsonField visible = root["visible"];
    check_size(visible, positions.size(), "frame");
    for (std::size_t f = 0; f < visible.size(); ++f) {
      truth.visible.push_back(flag(visible[f]));
    }
  }
  read_range(root, truth);
  return truth;
}

Truth read_truth(const std::filesystem::path& file) {
  return parse_truth(read_text_file(file), file.string());
}

}  // namespace telemime
