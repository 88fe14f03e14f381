// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/readers/jsonl.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "telemime/core/files.h"
#include "telemime/core/json_field.h"
#include "telemime/outputs/numbers.h"

namespace telemime {
namespace {

using nlohmann::json;

constexpr std::int64_t kVersion = 1;

JsonSource source_of(const std::string& where) {
  return {where, ErrorKind::input, "is it a complete pose.jsonl written by telemime (docs/formats.md)?"};
}

Eigen::Vector3d metres(const JsonField& field) {
  const auto [x, y, z] = field.numbers<3>();
  return Eigen::Vector3d(x, y, z) / kMillimetresPerMetre;
}

Shape read_shape(const JsonField& object) {
  Shape shape;
  shape.stature = object["stature"].number() / kMillimetresPerMetre;
  shape.sleeve = object["sleeve"].number();
  shape.shoulders = object.has("shoulders") ? object["shoulders"].positive() : 1.0;
  const JsonField segments = object["segments"];
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    const JsonField scale = segments[kSegmentNames[s]];
    shape.segments[s] = {scale["length"].number(), scale["height"].number(), scale["width"].number()};
  }
  return shape;
}

JointLimits read_limits(const JsonField& object) {
  JointLimits limits;
  limits.name = object["name"].text();
  const JsonField ranges = object["limits"];
  for (std::size_t a = 0; a < kAngleCount; ++a) {
    const auto [min, max] = ranges[kAngleNames[a]].numbers<2>();
    limits.min[a] = min / kDegreesPerRadian;
    limits.max[a] = max / kDegreesPerRadian;
  }
  return limits;
}

PoseFile read_header(const JsonField& header) {
  header["format"].equals("telemime-pose");
  header["version"].integer(1, kVersion);
  PoseFile file;
  file.camera = read_camera(header["camera"]);
  file.fps = header["fps"].positive();
  if (header.has("shape")) {
    file.shape = read_shape(header["shape"]);
  }
  if (header.has("limits")) {
    file.limits = read_limits(header["limits"]);
  }
  file.header = header.value();
  return file;
}

PoseSpread read_spread(const JsonField& object) {
  constexpr double kSquareMillimetres = kMillimetresPerMetre * kMillimetresPerMetre;
  PoseSpread spread;
  const JsonField covariance = object["covariance"];
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const auto [xx, xy, xz, yy, yz, zz] = covariance[kJointNames[j]].numbers<6>();
    spread.covariance[j] << xx, xy, xz, xy, yy, yz, xz, yz, zz;
    spread.covariance[j] /= kSquareMillimetres;
  }
  spread.second_mode = object["second_mode"].number();
  spread.effective_particles = object["effective_particles"].number();
  return spread;
}

FaceMotion read_face(const JsonField& object) {
  const auto weight = [](const JsonField& field) {
    const double value = field.number();
    if (!(value >= 0.0 && value <= 1.0)) {
      field.fail("must be between 0 and 1");
    }
    return value;
  };
  FaceMotion face;
  face.confidence = weight(object["confidence"]);
  const auto [x, y, z, w] = object["head"].numbers<4>();
  face.head = Eigen::Quaterniond(w, x, y, z);
  constexpr double kRounding = 0.01;
  if (std::abs(face.head.norm() - 1.0) > kRounding) {
    object["head"].fail("must be a unit quaternion");
  }
  face.head.normalize();
  const auto [left, up] = object["gaze"].numbers<2>();
  face.gaze = Eigen::Vector2d(left, up) / kDegreesPerRadian;
  const JsonField expressions = object["expressions"];
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    face.expressions[i] = weight(expressions[kExpressionNames[i]]);
  }
  return face;
}

// Sizes and what was seen of the palm are not in the file; the joints are.
HandMotion read_hand(const JsonField& object) {
  HandMotion hand;
  hand.visibility = object["visibility"].number();
  hand.spread = object["spread"].number() / kMillimetresPerMetre;
  const auto [twisting, pivot, flexion] = object["wrist"].numbers<3>();
  hand.wrist = {.twisting = twisting / kDegreesPerRadian,
                .pivot = pivot / kDegreesPerRadian,
                .flexion = flexion / kDegreesPerRadian};
  hand.angles = object["angles"].numbers<kHandAngleCount>();
  for (double& angle : hand.angles) {
    angle /= kDegreesPerRadian;
  }
  const JsonField joints = object["joints"];
  if (joints.size() != kHandJointCount) {
    joints.fail("must have " + std::to_string(kHandJointCount) + " points");
  }
  for (std::size_t j = 0; j < kHandJointCount; ++j) {
    hand.joints[j] = metres(joints[j]);
  }
  return hand;
}

MotionFrame read_frame(const JsonField& line, const Camera& camera) {
  MotionFrame frame;
  frame.frame = line["frame"].integer(0, INT64_MAX);
  frame.time = line["time"].number();
  const std::string state = line["state"].text();
  if (state != "tracking" && state != "lost") {
    line["state"].fail("must be \"tracking\" or \"lost\"");
  }
  frame.state = state == "tracking" ? TrackState::tracking : TrackState::lost;
  const JsonField joints = line["joints"];
  for (std::size_t j = 0; j < kJointCount; ++j) {
    frame.joints.at[j] = metres(joints[kJointNames[j]]);
    frame.pixels[j] =
        frame.joints.at[j].z() > 0.0 ? camera.project(frame.joints.at[j]) : Eigen::Vector2d::Zero();
  }
  if (line.has("angles")) {
    const JsonField angles = line["angles"];
    for (std::size_t a = 0; a < kAngleCount; ++a) {
      frame.pose.angles[a] = angles[kAngleNames[a]].number() / kDegreesPerRadian;
    }
  }
  frame.pose.root = line.has("root") ? metres(line["root"]) : frame.joints[Joint::root];
  if (line.has("pixels")) {
    const JsonField pixels = line["pixels"];
    for (std::size_t j = 0; j < kJointCount; ++j) {
      const auto [u, v] = pixels[kJointNames[j]].numbers<2>();
      frame.pixels[j] = {u, v};
    }
  }
  if (line.has("score")) {
    frame.region_score = line["score"]["F"].number();
    frame.contour_score = line["score"]["D_C"].number();
  }
  if (line.has("evaluations")) {
    frame.evaluations = static_cast<int>(line["evaluations"].integer(0, INT32_MAX));
  }
  if (line.has("face")) {
    frame.face = read_face(line["face"]);
  }
  if (line.has("hands")) {
    frame.hands = {read_hand(line["hands"]["left"]), read_hand(line["hands"]["right"])};
  }
  if (line.has("spread")) {
    frame.spread = read_spread(line["spread"]);
  }
  if (line.has("ms")) {
    const JsonField stages = line["ms"];
    for (const auto& [stage, time] : stages.value().items()) {
      frame.stage_ms.emplace_back(stage, stages[stage].number());
    }
  }
  return frame;
}

}  // namespace

PoseFile parse_pose_jsonl(std::string_view text, const std::string& name) {
  PoseFile file;
  bool has_header = false;
  std::size_t line_number = 0;
  while (!text.empty()) {
    const std::size_t length = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, length);
    text.remove_prefix(std::min(length + 1, text.size()));
    ++line_number;
    if (line.find_first_not_of(" \t\r") == std::string_view::npos) {
      continue;
    }
    const JsonSource source = source_of(name + ", line " + std::to_string(line_number));
    const bool last = text.find_first_not_of(" \t\r\n") == std::string_view::npos;
    const auto object = has_header && last ? parse_if_json(line, source) : parse_json(line, source);
    if (!object) {
      file.complaint = source.name + " is truncated; it was dropped";
      return file;
    }
    const JsonField field(*object, source);
    if (!has_header) {
      file = read_header(field);
      has_header = true;
      continue;
    }
    file.frames.push_back(read_frame(field, file.camera));
    if (file.frames.size() > 1 && file.frames.back().frame <= file.frames[file.frames.size() - 2].frame) {
      field["frame"].fail("must be greater than in the line before");
    }
  }
  if (!has_header) {
    throw Error(ErrorKind::input, name + " is empty", source_of(name).remedy);
  }
  return file;
}

PoseFile read_pose_jsonl(const std::filesystem::path& file) {
  return parse_pose_jsonl(read_text_file(file), file.string());
}

}  // namespace telemime
