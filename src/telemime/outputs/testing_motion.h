// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "telemime/body/body.h"
#include "telemime/body/limits.h"
#include "telemime/body/motion_frame.h"
#include "telemime/core/random.h"
#include "telemime/outputs/encoder.h"

/// Motions with known results, for tests of outputs, smoothing and evaluation.
namespace telemime::testing_motion {

inline StreamHeader header() {
  StreamHeader header;
  header.body = make_body(Shape{});
  header.fps = 25.0;
  header.limits = anatomical_limits();
  header.config = {{"seed", 1}, {"search", {{"name", "particles"}, {"count", 700}}}};
  header.extra = {{"input", "clip.mp4"}};
  return header;
}

/// A tracked frame of this pose, its joints and pixels by forward kinematics.
inline MotionFrame frame_of(const Body& body, const Camera& camera, const Pose& pose, std::int64_t index,
                            double fps) {
  MotionFrame frame;
  frame.frame = index;
  frame.time = static_cast<double>(index) / fps;
  frame.state = TrackState::tracking;
  frame.pose = pose;
  frame.joints = forward_kinematics(body, pose).joints;
  for (std::size_t j = 0; j < kJointCount; ++j) {
    frame.pixels[j] = camera.project(frame.joints.at[j]);
  }
  frame.region_score = 0.25;
  frame.contour_score = 1.5;
  frame.evaluations = 700;
  frame.stage_ms = {{"capture", 1.25}, {"search", 20.5}};
  return frame;
}

/// A face with all numbers set.
inline FaceMotion random_face(Random& random) {
  FaceMotion face;
  face.confidence = random.uniform();
  face.head =
      Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
  face.gaze = {random.uniform(-0.6, 0.6), random.uniform(-0.5, 0.5)};
  for (double& value : face.expressions) {
    value = random.uniform();
  }
  return face;
}

/// Hands with all angles, sizes and turns of the palm set, at the wrists of this pose.
inline HandMotions random_hands(const Body& body, const Pose& pose, Random& random) {
  HandMotions hands;
  HandSizes sizes = average_hand(body.shape.stature);
  sizes.palm *= 1.1;
  for (std::size_t f = 0; f < kFingerCount; ++f) {
    sizes.base[f] += 0.02 * Eigen::Vector3d(0.5, 1.0, -1.0);
    sizes.bone[f][1] *= 0.9 + 0.05 * static_cast<double>(f);
  }
  for (HandMotion& hand : hands) {
    hand.sizes = sizes;
    hand.visibility = 1.0;
    hand.seen =
        Eigen::Quaterniond(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
    for (std::size_t a = 0; a < kHandAngleCount; ++a) {
      hand.angles[a] = random.uniform(hand_limits()[a].min, hand_limits()[a].max);
    }
  }
  place_hands(forward_kinematics(body, pose), hands);
  return hands;
}

/// A random pose inside the limits, 1.0 to 1.6 m in front of the camera.
inline Pose random_pose(const JointLimits& limits, Random& random) {
  Pose pose;
  pose.root = {random.uniform(-0.2, 0.2), random.uniform(0.2, 0.5), random.uniform(1.0, 1.6)};
  for (std::size_t a = 0; a < kAngleCount; ++a) {
    pose.angles[a] = random.uniform(limits.min[a], limits.max[a]);
  }
  return pose;
}

/// Both arms swing by a sine of `period` seconds in all angles; each frame shows the pose of `late` frames
/// before.
inline std::vector<MotionFrame> gesture(const StreamHeader& header, std::size_t count, double period = 2.0,
                                        double late = 0.0) {
  std::vector<MotionFrame> frames;
  for (std::size_t t = 0; t < count; ++t) {
    const double time = (static_cast<double>(t) - late) / header.fps;
    Pose pose;
    pose.root = {0.05 * std::sin(time), 0.45, 1.3};
    for (std::size_t a = 0; a < kAngleCount; ++a) {
      const double phase = 2.0 * std::numbers::pi * time / period + 0.7 * static_cast<double>(a);
      pose.angles[a] = 0.12 * std::sin(phase);
    }
    pose[Angle::l_shoulder_flexion] = -0.6 + 0.5 * std::sin(2.0 * std::numbers::pi * time / period);
    pose[Angle::r_shoulder_flexion] = -0.6 - 0.5 * std::cos(2.0 * std::numbers::pi * time / period);
    pose[Angle::l_shoulder_abduct] = 0.5;
    pose[Angle::r_shoulder_abduct] = -0.5;
    pose[Angle::l_elbow_flexion] = -1.0 + 0.4 * std::sin(2.0 * std::numbers::pi * time / period);
    pose[Angle::r_elbow_flexion] = -1.0;
    frames.push_back(frame_of(header.body, header.camera, pose, static_cast<std::int64_t>(t), header.fps));
  }
  return frames;
}

/// Makes a frame lost, with the body of the one before it, as outputs write it.
inline void lose(std::vector<MotionFrame>& frames, std::size_t index) {
  MotionFrame& frame = frames.at(index);
  const MotionFrame& before = frames.at(index - 1);
  frame.state = TrackState::lost;
  frame.pose = before.pose;
  frame.joints = before.joints;
  frame.pixels = before.pixels;
  frame.hands = before.hands;
}

/// The complete file of an encoder for these frames, with patches applied.
inline std::string encode_all(Encoder& encoder, const StreamHeader& header,
                              const std::vector<MotionFrame>& frames) {
  std::string file = encoder.begin(header);
  for (const MotionFrame& frame : frames) {
    file += encoder.frame(frame);
  }
  file += encoder.end();
  if (const auto patch = encoder.patch()) {
    file.replace(patch->offset, patch->bytes.size(), patch->bytes);
  }
  return file;
}

}  // namespace telemime::testing_motion
