// SPDX-License-Identifier: Apache-2.0
#include "telemime/outputs/all.h"

#include "telemime/outputs/clean_frames.h"
#include "telemime/outputs/numbers.h"

namespace telemime {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kMillimetreDecimals = 2;
constexpr int kDegreeDecimals = 4;
constexpr int kPixelDecimals = 3;
constexpr int kScoreDecimals = 6;

Json millimetres(const Eigen::Vector3d& metres) {
  Json list = Json::array();
  for (const double value : metres) {
    list.push_back(rounded(value * kMillimetresPerMetre, kMillimetreDecimals));
  }
  return list;
}

double degrees(double radians) {
  return rounded(radians * kDegreesPerRadian, kDegreeDecimals);
}

double millimetres(double metres) {
  return rounded(metres * kMillimetresPerMetre, kMillimetreDecimals);
}

Json camera_json(const Camera& camera) {
  return {{"width", camera.width},
          {"height", camera.height},
          {"fx", camera.fx},
          {"fy", camera.fy},
          {"cx", camera.cx},
          {"cy", camera.cy},
          {"pixel_origin", "centre of the top-left pixel"},
          {"distortion", camera.distortion}};
}

Json shape_json(const Shape& shape) {
  Json segments = Json::object();
  for (std::size_t s = 0; s < kSegmentCount; ++s) {
    const SegmentScale& scale = shape.segments[s];
    segments[std::string(kSegmentNames[s])] = {
        {"length", scale.length}, {"height", scale.height}, {"width", scale.width}};
  }
  return {{"stature", millimetres(shape.stature)},
          {"sleeve", shape.sleeve},
          {"shoulders", shape.shoulders},
          {"segments", segments}};
}

Json body_json(const Body& body) {
  return {{"neck_from_root", millimetres(body.neck_from_root)},
          {"head_from_neck", millimetres(body.head_from_neck)},
          {"head_top_from_head", millimetres(body.head_top_from_head)},
          {"l_shoulder_from_neck", millimetres(body.shoulder_from_neck[0])},
          {"r_shoulder_from_neck", millimetres(body.shoulder_from_neck[1])},
          {"clavicle_lift", millimetres(body.clavicle_lift)},
          {"clavicle_reach", millimetres(body.clavicle_reach)},
          {"l_upper_arm", millimetres(body.upper_arm_length[0])},
          {"r_upper_arm", millimetres(body.upper_arm_length[1])},
          {"l_forearm", millimetres(body.forearm_length[0])},
          {"r_forearm", millimetres(body.forearm_length[1])},
          {"l_hand", millimetres(body.hand_length[0])},
          {"r_hand", millimetres(body.hand_length[1])}};
}

Json limits_json(const JointLimits& limits) {
  Json ranges = Json::object();
  for (std::size_t a = 0; a < kAngleCount; ++a) {
    ranges[std::string(kAngleNames[a])] = {degrees(limits.min[a]), degrees(limits.max[a])};
  }
  return {{"name", limits.name}, {"limits", ranges}};
}

Json spread_json(const PoseSpread& spread) {
  constexpr double kSquareMillimetres = kMillimetresPerMetre * kMillimetresPerMetre;
  Json covariance = Json::object();
  for (std::size_t j = 0; j < kJointCount; ++j) {
    const Eigen::Matrix3d& c = spread.covariance[j];
    Json six = Json::array();
    for (const double value : {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)}) {
      six.push_back(rounded(value * kSquareMillimetres, 1));
    }
    covariance[std::string(kJointNames[j])] = six;
  }
  return {{"covariance", covariance},
          {"second_mode", rounded(spread.second_mode, 4)},
          {"effective_particles", rounded(spread.effective_particles, 1)}};
}

Json face_json(const FaceMotion& face) {
  constexpr int kRotationDecimals = 6;
  constexpr int kWeightDecimals = 3;
  Json expressions = Json::object();
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    expressions[std::string(kExpressionNames[i])] = rounded(face.expressions[i], kWeightDecimals);
  }
  Json head = Json::array();
  for (const double value : {face.head.x(), face.head.y(), face.head.z(), face.head.w()}) {
    head.push_back(rounded(value, kRotationDecimals));
  }
  return {{"confidence", rounded(face.confidence, kWeightDecimals)},
          {"head", head},
          {"gaze", {degrees(face.gaze.x()), degrees(face.gaze.y())}},
          {"expressions", expressions}};
}

Json hand_json(const HandMotion& hand) {
  Json angles = Json::array();
  for (const double angle : hand.angles) {
    angles.push_back(rounded(angle * kDegreesPerRadian, 2));
  }
  Json joints = Json::array();
  for (const Eigen::Vector3d& joint : hand.joints) {
    joints.push_back(millimetres(joint));
  }
  return {{"visibility", rounded(hand.visibility, 3)},
          {"spread", millimetres(hand.spread)},
          {"wrist", {degrees(hand.wrist.twisting), degrees(hand.wrist.pivot), degrees(hand.wrist.flexion)}},
          {"angles", angles},
          {"joints", joints}};
}

/// One line of text; bytes that are not UTF-8 (a file name in a configuration) become replacement characters.
std::string line(const Json& object) {
  return object.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
}

class JsonlEncoder final : public Encoder {
 public:
  std::string begin(const StreamHeader& header) override {
    return line({{"format", "telemime-pose"},
                 {"version", 1},
                 {"units",
                  {{"length", "mm"},
                   {"angle", "degree"},
                   {"time", "s"},
                   {"pixel", "input image"},
                   {"covariance", "mm^2: xx, xy, xz, yy, yz, zz, from the middle of the shoulders"}}},
                 {"axes", "camera: x right, y down, z forward; l_ and r_ are the person's own sides"},
                 {"fps", header.fps},
                 {"camera", camera_json(header.camera)},
                 {"joints", kJointNames},
                 {"angles", kAngleNames},
                 {"hand_joints", kHandJointNames},
                 {"hand_angles", kHandAngleNames},
                 {"shape", shape_json(header.body.shape)},
                 {"body", body_json(header.body)},
                 {"limits", limits_json(header.limits)},
                 {"config", Json(header.config)},
                 {"extra", Json(header.extra)}});
  }

  std::string frame(const MotionFrame& raw) override {
    const MotionFrame frame = clean_(raw);
    Json angles = Json::object();
    for (std::size_t a = 0; a < kAngleCount; ++a) {
      angles[std::string(kAngleNames[a])] = degrees(frame.pose.angles[a]);
    }
    Json joints = Json::object();
    Json pixels = Json::object();
    for (std::size_t j = 0; j < kJointCount; ++j) {
      joints[std::string(kJointNames[j])] = millimetres(frame.joints.at[j]);
      pixels[std::string(kJointNames[j])] = {rounded(frame.pixels[j].x(), kPixelDecimals),
                                             rounded(frame.pixels[j].y(), kPixelDecimals)};
    }
    Json ms = Json::object();
    for (const auto& [stage, time] : frame.stage_ms) {
      ms[stage] = rounded(time, 3);
    }
    Json object = {{"frame", frame.frame},
                   {"time", rounded(frame.time, 6)},
                   {"state", frame.state == TrackState::tracking ? "tracking" : "lost"},
                   {"angles", angles},
                   {"root", millimetres(frame.pose.root)},
                   {"joints", joints},
                   {"pixels", pixels},
                   {"score",
                    {{"F", rounded(frame.region_score, kScoreDecimals)},
                     {"D_C", rounded(frame.contour_score, kScoreDecimals)}}},
                   {"evaluations", frame.evaluations},
                   {"ms", ms}};
    if (frame.face) {
      object["face"] = face_json(*frame.face);
    }
    if (frame.hands) {
      object["hands"] = {{"left", hand_json((*frame.hands)[0])}, {"right", hand_json((*frame.hands)[1])}};
    }
    if (frame.spread) {
      object["spread"] = spread_json(*frame.spread);
    }
    return line(object);
  }

 private:
  CleanFrames clean_;
};

}  // namespace

std::unique_ptr<Encoder> make_jsonl_encoder() {
  return std::make_unique<JsonlEncoder>();
}

}  // namespace telemime
