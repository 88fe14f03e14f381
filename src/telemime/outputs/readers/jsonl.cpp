// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/readers/jsonl.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "telemime/core/errors.h"
#include "telemime/outputs/numbers.h"
#include "telemime/outputs/readers/json_fields.h"
#include "telemime/outputs/readers/text_file.h"

namespace telemime {
namespace {

using nlohmann::json;

constexpr std::int64_t kVersion = 1;

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw Error(ErrorKind::input, where + ": " + what, "is it a pose.jsonl written by telemime?");
}

Eigen::Vector3d metres(const json& value, const std::string& where) {
  return fields::vector3(value, where) / kMillimetresPerMetre;
}

Shape read_shape(const json& object, const std::string& where) {
  Shape shape;
  shape.stature = fields::number_at(object, "stature", where) / kMillimetresPerMetre;
  shape.sleeve = fields::number_at(object, "sleeve", where);
  const json& segments = fields::member(object, "segments", where);
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    const json& scale = fields::member(segments, std::string(kSegmentNames[s]), where);
    shape.segments[s] = {fields::number_at(scale, "length", where), fields::number_at(scale, "height", where),
                         fields::number_at(scale, "width", where)};
  }
  return shape;
}

JointLimits read_limits(const json& object, const std::string& where) {
  JointLimits limits;
  limits.name = fields::text_at(object, "name", where);
  const json& ranges = fields::member(object, "limits", where);
  for (std::size_t a = 0; a < kAngleCount; ++a) {
    const std::string name(kAngleNames[a]);
    const json& range = fields::member(ranges, name, where);
    if (!range.is_array() || range.size() != 2) {
      fail(where, "the limits of " + name + " must be [min, max]");
    }
    const std::string place = std::string(where).append(": ").append(name);
    limits.min[a] = fields::number(range[0], place) / kDegreesPerRadian;
    limits.max[a] = fields::number(range[1], place) / kDegreesPerRadian;
  }
  return limits;
}

PoseFile read_header(const json& header, const std::string& where) {
  if (fields::text_at(header, "format", where) != "telemime-pose") {
    fail(where, "\"format\" is not \"telemime-pose\"");
  }
  fields::integer_at(header, "version", 1, kVersion, where);
  PoseFile file;
  file.camera = fields::camera(fields::member(header, "camera", where), where + ": \"camera\"");
  file.fps = fields::number_at(header, "fps", where);
  if (!(file.fps > 0.0)) {
    fail(where, "\"fps\" must be greater than 0");
  }
  if (header.contains("shape")) {
    file.shape = read_shape(header.at("shape"), where + ": \"shape\"");
  }
  if (header.contains("limits")) {
    file.limits = read_limits(header.at("limits"), where + ": \"limits\"");
  }
  file.header = header;
  return file;
}

void read_pixels(const json& object, const std::string& where, MotionFrame& frame) {
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const json& pixel = fields::member(object, std::string(kJointNames[j]), where);
    if (!pixel.is_array() || pixel.size() != 2) {
      fail(where, "a pixel must be [u, v]");
    }
    frame.pixels[j] = {fields::number(pixel[0], where), fields::number(pixel[1], where)};
  }
}

PoseSpread read_spread(const json& object, const std::string& where) {
  constexpr double kSquareMillimetres = kMillimetresPerMetre * kMillimetresPerMetre;
  PoseSpread spread;
  const json& covariance = fields::member(object, "covariance", where);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const json& six = fields::member(covariance, std::string(kJointNames[j]), where);
    if (!six.is_array() || six.size() != 6) {
      fail(where, "a covariance must be [xx, xy, xz, yy, yz, zz]");
    }
    std::array<double, 6> c{};
    for (std::size_t i = 0; i < c.size(); ++i) {
      c[i] = fields::number(six[i], where) / kSquareMillimetres;
    }
    spread.covariance[j] << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  }
  spread.second_mode = fields::number_at(object, "second_mode", where);
  spread.effective_particles = fields::number_at(object, "effective_particles", where);
  return spread;
}

MotionFrame read_frame(const json& object, const Camera& camera, const std::string& where) {
  MotionFrame frame;
  frame.frame = fields::integer_at(object, "frame", 0, INT64_MAX, where);
  frame.time = fields::number_at(object, "time", where);
  const std::string state = fields::text_at(object, "state", where);
  if (state != "tracking" && state != "lost") {
    fail(where, "\"state\" must be \"tracking\" or \"lost\"");
  }
  frame.state = state == "tracking" ? TrackState::tracking : TrackState::lost;
  const json& joints = fields::member(object, "joints", where);
  for (std::size_t j = 0; j < kJointCount; ++j) {
    frame.joints.at[j] = metres(fields::member(joints, std::string(kJointNames[j]), where), where);
    frame.pixels[j] =
        frame.joints.at[j].z() > 0.0 ? camera.project(frame.joints.at[j]) : Eigen::Vector2d::Zero();
  }
  if (object.contains("angles")) {
    for (std::size_t a = 0; a < kAngleCount; ++a) {
      frame.pose.angles[a] =
          fields::number_at(object.at("angles"), std::string(kAngleNames[a]), where) / kDegreesPerRadian;
    }
  }
  frame.pose.root = object.contains("root") ? metres(object.at("root"), where) : frame.joints[Joint::root];
  if (object.contains("pixels")) {
    read_pixels(object.at("pixels"), where, frame);
  }
  if (object.contains("score")) {
    frame.region_score = fields::number_at(object.at("score"), "F", where);
    frame.contour_score = fields::number_at(object.at("score"), "D_C", where);
  }
  if (object.contains("evaluations")) {
    frame.evaluations = static_cast<int>(fields::integer_at(object, "evaluations", 0, INT32_MAX, where));
  }
  if (object.contains("spread")) {
    frame.spread = read_spread(object.at("spread"), where + ": \"spread\"");
  }
  if (object.contains("ms")) {
    for (const auto& [stage, time] : object.at("ms").items()) {
      frame.stage_ms.emplace_back(stage, fields::number(time, where + ": \"ms\""));
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
    const std::string where = name + ", line " + std::to_string(line_number);
    const std::optional<json> object = fields::parse(line, where);
    if (!object) {
      if (has_header && text.find_first_not_of(" \t\r\n") == std::string_view::npos) {
        file.complaint = where + " is cut off; it was left out";
        return file;
      }
      fail(where, "not JSON");
    }
    if (!has_header) {
      file = read_header(*object, where);
      has_header = true;
      continue;
    }
    file.frames.push_back(read_frame(*object, file.camera, where));
    if (file.frames.size() > 1 && file.frames.back().frame <= file.frames[file.frames.size() - 2].frame) {
      fail(where, "the frame numbers must increase");
    }
  }
  if (!has_header) {
    fail(name, "the file is empty");
  }
  return file;
}

PoseFile read_pose_jsonl(const std::filesystem::path& file) {
  return parse_pose_jsonl(read_text_file(file), file.string());
}

}  // namespace telemime
