// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "telemime/outputs/clean_frames.h"
#include "telemime/outputs/encoder.h"
#include "telemime/outputs/humanoid.h"

namespace telemime {

/// Converts the frames of one person to poses of their humanoid skeleton. In the first tracked frame the hips
/// are above those of the skeleton; later they move relative to that place.
class PersonMotion {
 public:
  explicit PersonMotion(const Body& body) : body_(body), skeleton_(humanoid_skeleton(body)) {}

  const Body& body() const { return body_; }
  const HumanoidSkeleton& skeleton() const { return skeleton_; }
  /// The frame as outputs see it (outputs/clean_frames.h). Call it once per frame, in order.
  MotionFrame clean(const MotionFrame& frame) { return clean_(frame); }
  /// The pose of a frame that clean() returned; nothing if the person is lost in it.
  std::optional<HumanoidMotion> operator()(const MotionFrame& frame) {
    if (frame.state == TrackState::lost) {
      return std::nullopt;
    }
    if (!origin_) {
      origin_ = frame.pose.root;
    }
    HumanoidMotion motion = humanoid_motion(body_, frame, *origin_);
    if (frame.face) {
      turn_head(*frame.face, motion);
    }
    return motion;
  }

 private:
  Body body_;
  HumanoidSkeleton skeleton_;
  CleanFrames clean_;
  std::optional<Eigen::Vector3d> origin_;  ///< m, camera frame
};

}  // namespace telemime
