// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "telemime/outputs/encoder.h"
#include "telemime/outputs/finite.h"
#include "telemime/outputs/humanoid.h"

namespace telemime {

/// One person's frames as poses of their humanoid skeleton. The hips stand over the skeleton's in the first
/// tracked frame, and move from there.
class PersonMotion {
 public:
  explicit PersonMotion(const Body& body) : body_(body), skeleton_(humanoid_skeleton(body)) {}

  const Body& body() const { return body_; }
  const HumanoidSkeleton& skeleton() const { return skeleton_; }
  /// The frame with everything finite (outputs/finite.h); call it once for each frame, in order.
  MotionFrame clean(const MotionFrame& frame) { return finite_(frame); }
  /// The pose of a frame that clean() gave, nothing when the person is lost in it.
  std::optional<HumanoidMotion> operator()(const MotionFrame& frame) {
    if (frame.state == TrackState::lost) {
      return std::nullopt;
    }
    if (!origin_) {
      origin_ = frame.pose.root;
    }
    return humanoid_motion(body_, frame.pose, *origin_);
  }

 private:
  Body body_;
  HumanoidSkeleton skeleton_;
  FiniteFrames finite_;
  std::optional<Eigen::Vector3d> origin_;  ///< m, camera frame
};

}  // namespace telemime
