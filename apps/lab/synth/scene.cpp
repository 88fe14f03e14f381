// SPDX-License-Identifier: Apache-2.0
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "lab/synth/sequence.h"
#include "telemime/body/arm_parts.h"
#include "telemime/body/hand_model.h"
#include "telemime/core/errors.h"

namespace telemime {
namespace {

// Random streams of the seed: draws from one never shift those from another.
constexpr std::uint64_t kLookStream = 1;
constexpr std::uint64_t kBackdropStream = 2;
constexpr std::uint64_t kFingerStream = 3;
constexpr std::uint64_t kMeshStream = 4;
// The background clip's noise must not repeat that of the frames.
constexpr std::uint64_t kBackgroundFrames = 1'000'000;

constexpr std::array<Joint, kJointCount> kTruthOrder = {
    Joint::root,    Joint::neck,    Joint::head,    Joint::l_shoulder, Joint::r_shoulder, Joint::l_elbow,
    Joint::r_elbow, Joint::l_wrist, Joint::r_wrist, Joint::head_top,   Joint::l_hand,     Joint::r_hand};
constexpr std::array<std::pair<Joint, Joint>, 10> kTruthBones = {{{Joint::neck, Joint::head},
                                                                  {Joint::head, Joint::head_top},
                                                                  {Joint::l_shoulder, Joint::r_shoulder},
                                                                  {Joint::l_shoulder, Joint::l_elbow},
                                                                  {Joint::l_elbow, Joint::l_wrist},
                                                                  {Joint::r_shoulder, Joint::r_elbow},
                                                                  {Joint::r_elbow, Joint::r_wrist},
                                                                  {Joint::l_wrist, Joint::l_hand},
                                                                  {Joint::r_wrist, Joint::r_hand},
                                                                  {Joint::root, Joint::neck}}};

std::string name_of(Joint joint) {
  return std::string(kJointNames[static_cast<std::size_t>(joint)]);
}

// A clip in which the person walks in and out, in frames: empty, walking in, the gesture, walking out, empty.
constexpr int kEmptyBefore = 28;
constexpr int kWalk = 32;
constexpr int kEmptyAfter = 14;
constexpr int kShortestWalkIn = 120;

// Frames since the start of the walk in and until the end of the walk out; one of them is negative while the
// scene is empty.
struct WalkTime {
  int since_start;
  int until_end;
};

WalkTime walk_time(const SceneOptions& options, int frame) {
  return {frame - kEmptyBefore, options.frames - kEmptyAfter - 1 - frame};
}

bool is_present(const SceneOptions& options, int frame) {
  const WalkTime time = walk_time(options, frame);
  return !options.walk_in || (time.since_start >= 0 && time.until_end >= 0);
}

// Moves a seated pose to where the person is on the way in or out, turned to the direction of walking.
void walk(const SceneOptions& options, int frame, ActorPose& pose) {
  constexpr double kWay = 1.6;   // m, from outside the image to the seat
  constexpr double kTurn = 1.0;  // rad
  const WalkTime time = walk_time(options, frame);
  const int nearest = std::min(time.since_start, time.until_end);
  const double s = std::clamp(static_cast<double>(nearest) / kWalk, 0.0, 1.0);
  const double left = 1.0 - s * s * (3.0 - 2.0 * s);  // of the way, 1 outside ... 0 seated
  const double direction = time.since_start < time.until_end ? -1.0 : 1.0;
  pose.root.x() += kWay * left;
  pose.root.y() -= 0.02 * std::abs(std::sin(4.0 * left));
  pose.turn += direction * kTurn * std::min(1.0, 3.0 * left);
}

double hundredths(double value) {
  return std::round(value * 100.0) / 100.0;
}

Lighting lighting_at(const SceneOptions& options, int frame) {
  Lighting lights;
  if (options.light_change) {
    const int middle = options.frames / 2;
    lights.lamp = std::clamp(static_cast<float>(frame - middle + 1) / 3.0f, 0.0f, 1.0f);
  }
  return lights;
}

// Linear light (CV_32FC3) to the picture that the camera gives (CV_8UC3, BGR, gamma 2). The noise of a pixel
// depends on seed, frame and pixel alone, not on the number of threads.
cv::Mat develop(const cv::Mat& light, const Sensor& sensor, std::uint64_t seed, std::uint64_t frame) {
  // One stream per row, one more for the frame's gain.
  const std::uint64_t first = (frame + 1) << 20;
  Random gain_random(seed, first);
  const auto gain = static_cast<float>(255.0 * (1.0 + gain_random.normal(0.0, sensor.flicker)));
  cv::Mat picture(light.size(), CV_8UC3);
  tbb::parallel_for(tbb::blocked_range<int>(0, light.rows), [&](const tbb::blocked_range<int>& range) {
    for (int y = range.begin(); y < range.end(); ++y) {
      Random random(seed, first + 1 + static_cast<std::uint64_t>(y));
      const auto* in = light.ptr<cv::Vec3f>(y);
      auto* out = picture.ptr<cv::Vec3b>(y);
      for (int x = 0; x < light.cols; ++x) {
        for (int c = 0; c < 3; ++c) {
          const float value = gain * std::sqrt(std::max(in[x][c], 0.0f));
          const double noise = sensor.noise > 0.0 ? random.normal(0.0, sensor.noise) : 0.0;
          out[x][c] = cv::saturate_cast<uchar>(static_cast<double>(value) + noise);
        }
      }
    }
  });
  return picture;
}

}  // namespace

Scene make_scene(const SceneOptions& options) {
  if (options.width < 16 || options.height < 12 || options.width > 4096 || options.height > 4096) {
    throw Error(ErrorKind::usage,
                "the image size " + std::to_string(options.width) + "x" + std::to_string(options.height) +
                    " cannot be rendered",
                "choose a size from 16x12 to 4096x4096, for instance 640x480");
  }
  if (options.frames < 1) {
    throw Error(ErrorKind::usage, "a clip needs at least 1 frame", "choose a larger number of frames");
  }
  if (!(options.sensor.noise >= 0.0) || !(options.sensor.flicker >= 0.0)) {
    throw Error(ErrorKind::usage, "noise and flicker cannot be negative", "choose 0 for a clean picture");
  }
  if (options.distance != 0.0 && !(options.distance >= 0.6 && options.distance <= 1.8)) {
    throw Error(ErrorKind::usage, "the person cannot be that near or far",
                "choose a distance of 0.6 to 1.8 m");
  }
  // A little more than 30 and 90 degrees: those are rounded on their way here.
  constexpr double kMostPitch = std::numbers::pi / 6.0 + 1e-6;
  constexpr double kMostTurn = std::numbers::pi / 2.0 + 1e-6;
  if (!(std::abs(options.camera_pitch) <= kMostPitch) || !(std::abs(options.turn) <= kMostTurn)) {
    throw Error(ErrorKind::usage, "the camera cannot be pitched, or the person turned, that far",
                "choose a pitch of at most 30 and a turn of at most 90 degrees, either way");
  }
  if (options.striped_shirt && !options.people.empty()) {
    throw Error(ErrorKind::usage, "people of meshes wear their own clothes", "leave --striped out");
  }
  if (options.walk_in && options.frames < kShortestWalkIn) {
    throw Error(ErrorKind::usage, "walking in and out takes longer than the clip",
                "choose 120 frames or more");
  }
  Scene scene;
  scene.options = options;
  scene.camera = camera_from_field_of_view(options.width, options.height, options.field_of_view);
  Random look_random(options.seed, kLookStream);
  scene.look = random_look(look_random);
  scene.look.striped = options.striped_shirt;
  if (options.long_sleeves) {
    scene.look.sleeve = 1.97;
  }
  if (!options.people.empty()) {
    Random mesh_random(options.seed, kMeshStream);
    scene.mesh = std::make_shared<const MeshPerson>(
        read_mesh_person(options.people, random_mesh_look(options.long_sleeves, mesh_random)));
  }
  Random backdrop_random(options.seed, kBackdropStream);
  scene.backdrop = make_backdrop(scene.camera, scene.look.shirt_index, backdrop_random);
  return scene;
}

namespace {

// Each finger bends and stretches by a sine of its own; now and then all are nearly straight or bent.
void move_fingers(double time, std::uint64_t seed, ActorPose& pose) {
  Random random(seed, kFingerStream);
  for (ActorArm& arm : pose.arms) {
    const double together = std::sin(random.uniform(0.9, 1.4) * time + random.uniform(0.0, 6.28));
    for (double& curl : arm.curl_by_finger) {
      const double own = std::sin(random.uniform(1.5, 3.0) * time + random.uniform(0.0, 6.28));
      curl = 0.42 + 0.3 * together + 0.2 * own - arm.curl;
    }
  }
}

// The joints of both hands in every frame, mm.
nlohmann::ordered_json hands_truth(const std::vector<PersonTruth>& truths) {
  nlohmann::ordered_json hands{{"joints", kHandJointNames}};
  for (const PersonTruth& truth : truths) {
    for (std::size_t side = 0; side < 2; ++side) {
      nlohmann::ordered_json points;
      for (const Eigen::Vector3d& joint : truth.hands[side]) {
        const Eigen::Vector3d mm = 1000.0 * joint;
        points.push_back({hundredths(mm.x()), hundredths(mm.y()), hundredths(mm.z())});
      }
      hands[side == 0 ? "left" : "right"].push_back(std::move(points));
    }
  }
  return hands;
}

// Camera from head as FaceMotion has it: x to the person's left, y to the chin, z to the back; x, y, z, w.
nlohmann::ordered_json head_truth(const PersonTruth& truth) {
  const Eigen::Vector3d head_axes(1.0, -1.0, -1.0);
  const Eigen::Quaterniond q(Eigen::Matrix3d(truth.bones.camera_from_head.linear() * head_axes.asDiagonal()));
  nlohmann::ordered_json out;
  for (const double c : {q.x(), q.y(), q.z(), q.w()}) {
    out.push_back(std::round(1e4 * c) / 1e4);
  }
  return out;
}

bool is_visible(const Scene& scene, int frame, const PersonTruth& truth) {
  const double u = scene.camera.project(truth.bones.joints[Joint::neck]).x();
  return is_present(scene.options, frame) && u >= 0.0 && u < scene.camera.width;
}

}  // namespace

ActorKinematics scene_kinematics(const Scene& scene, int frame) {
  const SceneOptions& options = scene.options;
  // Walking in ends where the gesture starts.
  const int moment = options.walk_in ? std::max(0, frame - kEmptyBefore - kWalk) : frame;
  ActorPose pose = gesture_pose(options.gesture, moment, options.seed);
  if (options.distance > 0.0) {
    constexpr double kStaged = 1.39;
    // A person near the camera is lower in the camera frame, so that the head stays in the image.
    pose.root.y() += 0.16 * (kStaged - options.distance);
    pose.root.z() += options.distance - kStaged;
  }
  // The person leans back in the frame of the camera; as in any lean, the neck takes most of it back.
  pose.lean -= options.camera_pitch;
  pose.turn += options.turn;
  pose.look -= options.turn;
  if (options.look_around > 0.0) {
    const double t = moment / kGestureFps;
    // At most 84 degrees per second.
    pose.look += options.look_around * std::sin(std::min(2.1, 1.47 / options.look_around) * t);
    pose.nod += 0.26 * std::sin(1.3 * t + 0.5);
  }
  if (options.fingers) {
    move_fingers(moment / kGestureFps, options.seed, pose);
  }
  if (options.walk_in) {
    walk(options, frame, pose);
  }
  return actor_kinematics(scene.look.build, pose);
}

PersonTruth scene_truth(const Scene& scene, int frame) {
  const ActorKinematics k = scene_kinematics(scene, frame);
  if (scene.mesh != nullptr) {
    return mesh_truth(*scene.mesh, k);
  }
  PersonTruth truth{k, {points_at_origin(), points_at_origin()}};
  const double scale = scene.look.build.hand / kHandKnuckle;
  for (std::size_t side = 0; side < 2; ++side) {
    const auto joints = hand_joints(hand_shape(k.curl[side]));
    for (std::size_t j = 0; j < joints.size(); ++j) {
      truth.hands[side][j] =
          k.joints[kArmParts[side].wrist] + k.camera_from_hand[side] * joints[j].cast<double>() * scale;
    }
  }
  return truth;
}

bool person_is_visible(const Scene& scene, int frame) {
  return is_visible(scene, frame, scene_truth(scene, frame));
}

SynthFrame render_frame(const Scene& scene, int frame) {
  const ActorKinematics kinematics = scene_kinematics(scene, frame);
  const Lighting lighting = lighting_at(scene.options, frame);
  RenderedImage picture;
  JointPositions joints = kinematics.joints;
  if (scene.mesh != nullptr) {
    const PosedMesh posed = pose_mesh(*scene.mesh, kinematics);
    joints = posed.truth.bones.joints;
    picture = is_present(scene.options, frame)
                  ? render_mesh_scene(scene.camera, scene.backdrop, *scene.mesh, posed, lighting)
                  : render_scene(scene.camera, scene.backdrop, nullptr, lighting);
  } else {
    const Avatar avatar = make_avatar(scene.look, kinematics);
    picture = render_scene(scene.camera, scene.backdrop, is_present(scene.options, frame) ? &avatar : nullptr,
                           lighting);
  }
  return {develop(picture.light, scene.options.sensor, scene.options.seed, static_cast<std::uint64_t>(frame)),
          picture.surfaces, joints};
}

cv::Mat render_background(const Scene& scene, int index) {
  const RenderedImage picture = render_scene(scene.camera, scene.backdrop, nullptr, Lighting{});
  return develop(picture.light, scene.options.sensor, scene.options.seed,
                 kBackgroundFrames + static_cast<std::uint64_t>(index));
}

std::string truth_json(const Scene& scene) {
  using Json = nlohmann::ordered_json;
  const Camera& camera = scene.camera;
  const Camera small = camera.scaled_to(160, 160 * camera.height / camera.width);
  Json truth;
  truth["name"] = kGestureNames[static_cast<std::size_t>(scene.options.gesture)];
  truth["fps"] = static_cast<int>(kGestureFps);
  truth["width"] = camera.width;
  truth["height"] = camera.height;
  truth["fx"] = camera.fx;
  truth["fy"] = camera.fy;
  truth["cx"] = camera.cx;
  truth["cy"] = camera.cy;
  truth["pixel_convention"] = "u=fx*x/z+cx is measured from the CENTRE of the top-left pixel (OpenCV)";
  truth["small"] = Json{{"width", small.width}, {"height", small.height}, {"fx", small.fx},
                        {"fy", small.fy},       {"cx", small.cx},         {"cy", small.cy}};
  truth["units"] = "mm";
  truth["frame"] = "camera: x right, y down, z forward";
  truth["sides"] = "l_/r_ are the person's own left/right; the image is not mirrored";
  for (const Joint joint : kTruthOrder) {
    truth["joints"].push_back(name_of(joint));
  }
  std::vector<PersonTruth> truths;
  truths.reserve(static_cast<std::size_t>(scene.options.frames));
  for (int frame = 0; frame < scene.options.frames; ++frame) {
    truths.push_back(scene_truth(scene, frame));
  }
  const JointPositions& first = truths.front().bones.joints;
  for (const auto& [a, b] : kTruthBones) {
    truth["bone_lengths"][name_of(a) + "-" + name_of(b)] = hundredths((first[a] - first[b]).norm() * 1000.0);
  }
  truth["frames"] = scene.options.frames;
  truth["note"] = gesture_note(scene.options.gesture);
  truth["positions"] = Json::array();
  for (int frame = 0; frame < scene.options.frames; ++frame) {
    const PersonTruth& person = truths[static_cast<std::size_t>(frame)];
    Json row = Json::array();
    for (const Joint joint : kTruthOrder) {
      const Eigen::Vector3d mm = person.bones.joints[joint] * 1000.0;
      row.push_back({hundredths(mm.x()), hundredths(mm.y()), hundredths(mm.z())});
    }
    truth["positions"].push_back(std::move(row));
    truth["head"].push_back(head_truth(person));
    if (scene.options.walk_in) {
      truth["visible"].push_back(is_visible(scene, frame, person));
    }
  }
  if (scene.options.fingers) {
    truth["hands"] = hands_truth(truths);
  }
  return truth.dump();
}

}  // namespace telemime
