// SPDX-License-Identifier: Apache-2.0
#pragma once

// Motion for the tests of this folder. Not installed.

#include <functional>
#include <vector>

#include "telemime/body/body.h"
#include "telemime/body/motion_frame.h"
#include "telemime/core/camera.h"

namespace telemime::testing {

inline constexpr double kFps = 25.0;

/// A body before a camera, to make frames with.
struct Stage {
  Body body = make_body(Shape{});
  Camera camera;

  MotionFrame frame(const Pose& pose, int index) const {
    MotionFrame result;
    result.frame = index;
    result.time = index / kFps;
    result.state = TrackState::tracking;
    result.pose = pose;
    result.joints = forward_kinematics(body, pose).joints;
    for (std::size_t j = 0; j < kJointCount; ++j) {
      result.pixels[j] = camera.project(result.joints.at[j]);
    }
    return result;
  }

  std::vector<MotionFrame> frames(int count, const std::function<Pose(int)>& pose) const {
    std::vector<MotionFrame> result;
    result.reserve(static_cast<std::size_t>(count));
    for (int t = 0; t < count; ++t) {
      result.push_back(frame(pose(t), t));
    }
    return result;
  }
};

inline Pose standing() {
  Pose pose;
  pose.root = {0.0, 0.45, 1.3};
  return pose;
}

}  // namespace telemime::testing
