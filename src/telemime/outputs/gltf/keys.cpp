// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/gltf/keys.h"

#include <utility>

namespace telemime {
namespace {

void append(std::vector<float>& column, const Eigen::Quaterniond& rotation) {
  const Eigen::Quaternionf q = rotation.cast<float>().normalized();
  column.insert(column.end(), {q.x(), q.y(), q.z(), q.w()});
}

void repeat_last(std::vector<float>& column, std::size_t width) {
  const std::size_t from = column.size() - width;
  for (std::size_t i = 0; i < width; ++i) {
    column.push_back(column[from + i]);
  }
}

}  // namespace

void MotionKeys::Columns::add(float time, const HumanoidMotion& motion) {
  times.push_back(time);
  const Eigen::Vector3f place = motion.hips.cast<float>();
  hips.insert(hips.end(), place.begin(), place.end());
  for (std::size_t b = 0; b < kMovingBoneCount; ++b) {
    append(rotations[b], motion.rotation[b]);
  }
}

// A frame without hands keeps the fingers as they were.
void MotionKeys::Columns::add_fingers(const std::optional<FingerRotations>& turned) {
  for (std::size_t b = 0; b < kFingerBoneCount; ++b) {
    if (turned) {
      append(fingers[b], (*turned)[b]);
    } else if (fingers[b].empty()) {
      append(fingers[b], Eigen::Quaterniond::Identity());
    } else {
      repeat_last(fingers[b], 4);
    }
  }
}

void MotionKeys::Columns::add_face(const FaceMotion& face) {
  const auto weights = vrm_expressions(face);
  for (std::size_t i = 0; i < kAnimatedExpressionCount; ++i) {
    expressions[i].insert(expressions[i].end(), {static_cast<float>(weights[i]), 0.0F, 0.0F});
  }
  // Seen from the avatar, which faces +z: about y to its left, then about x downwards.
  append(gaze, Eigen::AngleAxisd(face.gaze.x(), Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(-face.gaze.y(), Eigen::Vector3d::UnitX()));
}

void MotionKeys::Columns::hold(float time) {
  times.push_back(time);
  repeat_last(hips, 3);
  for (std::vector<float>& rotation : rotations) {
    repeat_last(rotation, 4);
  }
  if (!fingers[0].empty()) {
    for (std::vector<float>& finger : fingers) {
      repeat_last(finger, 4);
    }
  }
  if (!gaze.empty()) {
    for (std::vector<float>& expression : expressions) {
      repeat_last(expression, 3);
    }
    repeat_last(gaze, 4);
  }
}

MotionKeys::MotionKeys(const Body& body, bool fingers, std::optional<std::size_t> face_node)
    : body_(body), fingers_(fingers), face_node_(face_node) {}

void MotionKeys::add(const MotionFrame& frame) {
  if (!start_) {
    start_ = frame.time;
  }
  const auto time = static_cast<float>(frame.time - *start_);
  if (time <= last_time_) {
    return;
  }
  if (frame.state == TrackState::lost) {
    lost_ = count() > 0;
    last_time_ = time;
    return;
  }
  if (lost_) {
    columns_.hold(last_time_);
    lost_ = false;
  }
  last_time_ = time;
  if (!origin_) {
    origin_ = frame.pose.root;
  }
  HumanoidMotion motion = humanoid_motion(body_, frame, *origin_);
  if (frame.face) {
    turn_head(*frame.face, motion);
  }
  columns_.add(time, motion);
  if (fingers_) {
    columns_.add_fingers(motion.fingers);
    skeleton_ = frame.hands ? finger_skeleton(*frame.hands) : skeleton_;
  }
  if (face_node_) {
    columns_.add_face(frame.face.value_or(FaceMotion{}));
  }
}

void MotionKeys::add_animation(GltfDocument& document) const {
  Columns columns = columns_;
  if (lost_) {
    columns.hold(last_time_);
  }
  if (columns.times.empty()) {
    HumanoidMotion rest;
    rest.hips = humanoid_skeleton(body_).position[0];
    rest.rotation.fill(Eigen::Quaterniond::Identity());
    columns.add(0.0F, rest);
    columns.add_fingers(std::nullopt);
    columns.add_face(FaceMotion{});
  }
  const std::size_t input = add_accessor(document, columns.times, "SCALAR", GltfTarget::none, true);
  auto channels = nlohmann::ordered_json::array();
  auto samplers = nlohmann::ordered_json::array();
  const auto track = [&](std::size_t node, const char* path, std::size_t output) {
    channels.push_back({{"sampler", samplers.size()}, {"target", {{"node", node}, {"path", path}}}});
    samplers.push_back({{"input", input}, {"interpolation", "LINEAR"}, {"output", output}});
  };
  track(static_cast<std::size_t>(HumanBone::hips), "translation",
        add_accessor(document, columns.hips, "VEC3"));
  for (std::size_t b = 0; b < kMovingBoneCount; ++b) {
    track(b, "rotation", add_accessor(document, columns.rotations[b], "VEC4"));
  }
  for (std::size_t b = 0; fingers_ && b < kFingerBoneCount; ++b) {
    track(finger_node(b), "rotation", add_accessor(document, columns.fingers[b], "VEC4"));
  }
  if (face_node_) {
    for (std::size_t i = 0; i < kAnimatedExpressionCount; ++i) {
      track(*face_node_ + i, "translation", add_accessor(document, columns.expressions[i], "VEC3"));
    }
    track(*face_node_ + kAnimatedExpressionCount, "rotation", add_accessor(document, columns.gaze, "VEC4"));
  }
  add_to(document, "animations",
         {{"name", "motion"}, {"channels", std::move(channels)}, {"samplers", std::move(samplers)}});
}

}  // namespace telemime
