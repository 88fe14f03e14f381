// SPDX-License-Identifier: Apache-2.0
#include "telemime/streaming/pose_message.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "telemime/outputs/numbers.h"
#include "telemime/outputs/vrm_expressions.h"

namespace telemime {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMetreDecimals = 5;
constexpr int kRotationDecimals = 6;
constexpr int kMillimetreDecimals = 2;
constexpr int kPixelDecimals = 2;
constexpr int kScoreDecimals = 4;
constexpr int kStampDecimals = 3;

Json vector_json(const Eigen::Vector3d& v, double unit, int decimals) {
  return {rounded(v.x() * unit, decimals), rounded(v.y() * unit, decimals), rounded(v.z() * unit, decimals)};
}

Json quaternion_json(const Eigen::Quaterniond& q) {
  return {rounded(q.x(), kRotationDecimals), rounded(q.y(), kRotationDecimals),
          rounded(q.z(), kRotationDecimals), rounded(q.w(), kRotationDecimals)};
}

bool is_leg(std::size_t bone) {
  return bone >= static_cast<std::size_t>(HumanBone::l_upper_leg);
}

void add_joints(const MotionFrame& frame, Json& message) {
  Json joints = Json::object();
  Json pixels = Json::object();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const std::string name(kJointNames[j]);
    joints[name] = vector_json(frame.joints.at[j], kMillimetresPerMetre, kMillimetreDecimals);
    pixels[name] = {rounded(frame.pixels[j].x(), kPixelDecimals),
                    rounded(frame.pixels[j].y(), kPixelDecimals)};
  }
  message["joints"] = std::move(joints);
  message["pixels"] = std::move(pixels);
}

void add_spread(const PoseSpread& spread, Json& message) {
  constexpr double kSquareMillimetres = kMillimetresPerMetre * kMillimetresPerMetre;
  Json ellipsoids = Json::object();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Eigen::Matrix3d& c = spread.covariance[j];
    Json six = Json::array();
    for (const double value : {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)}) {
      six.push_back(rounded(value * kSquareMillimetres, 1));
    }
    ellipsoids[std::string(kJointNames[j])] = std::move(six);
  }
  message["spread"] = std::move(ellipsoids);
  message["second_mode"] = rounded(spread.second_mode, kScoreDecimals);
}

/// The coefficients of ARKit as a list in the order of kExpressionNames, and the expressions of VRM by name.
Json face_json(const FaceMotion& face) {
  constexpr int kWeightDecimals = 3;
  Json arkit = Json::array();
  for (const double value : face.expressions) {
    arkit.push_back(rounded(value, kWeightDecimals));
  }
  Json vrm = Json::object();
  const auto weights = vrm_expressions(face);
  for (std::size_t i = 0; i < kVrmExpressionCount; ++i) {
    vrm[std::string(kVrmExpressionNames[i])] = rounded(weights[i], kWeightDecimals);
  }
  return {{"confidence", rounded(face.confidence, kWeightDecimals)},
          {"gaze", {rounded(face.gaze.x(), kWeightDecimals), rounded(face.gaze.y(), kWeightDecimals)}},
          {"arkit", std::move(arkit)},
          {"vrm", std::move(vrm)}};
}

/// Bytes that are not UTF-8 become replacement characters.
std::string text_of(const Json& message) {
  return message.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::string words_of(const nlohmann::json& extra, const char* name) {
  return extra.is_object() && extra.contains(name) && extra[name].is_string() ? extra[name].get<std::string>()
                                                                              : std::string();
}

}  // namespace

PoseMessages::PoseMessages(const StreamHeader& header)
    : motion_(header.body), scale_from_(words_of(header.extra, "scale_from")) {}

std::string PoseMessages::body() const {
  Json bones = Json::object();
  for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
    bones[std::string(kHumanBoneNames[b])] = vector_json(motion_.skeleton().position[b], 1.0, kMetreDecimals);
  }
  return text_of({{"type", "body"},
                  {"stature", rounded(motion_.body().shape.stature, kMetreDecimals)},
                  {"scale_from", scale_from_},
                  {"bones", bones}});
}

std::string PoseMessages::pose(const MotionFrame& raw, double stamp) {
  const MotionFrame frame = motion_.clean(raw);
  Json message = {{"type", "pose"},
                  {"frame", frame.frame},
                  {"time", rounded(frame.time, 6)},
                  {"stamp", std::isfinite(stamp) ? rounded(stamp, kStampDecimals) : 0.0},
                  {"state", frame.state == TrackState::tracking ? "tracking" : "lost"}};
  if (const auto motion = motion_(frame)) {
    message["hips"] = vector_json(motion->hips, 1.0, kMetreDecimals);
    Json bones = Json::object();
    for (std::size_t b = 0; b < kHumanBoneCount; ++b) {
      if (!is_leg(b)) {
        bones[std::string(kHumanBoneNames[b])] = quaternion_json(motion->rotation[b]);
      }
    }
    for (std::size_t b = 0; motion->fingers && b < kFingerBoneCount; ++b) {
      bones[std::string(kFingerBoneNames[b])] = quaternion_json((*motion->fingers)[b]);
    }
    message["bones"] = std::move(bones);
    add_joints(frame, message);
    if (frame.spread) {
      add_spread(*frame.spread, message);
    }
    if (frame.face) {
      message["face"] = face_json(*frame.face);
    }
    message["F"] = rounded(frame.region_score, kScoreDecimals);
    message["D_C"] = rounded(frame.contour_score, kScoreDecimals);
  }
  return text_of(message);
}

}  // namespace telemime
