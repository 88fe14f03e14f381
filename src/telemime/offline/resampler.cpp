// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/resampler.h"

#include "telemime/tracker/joint_rotations.h"
#include "telemime/tracker/smoother.h"

namespace telemime {
namespace {

Pose blend(const Pose& a, const Pose& b, double share) {
  const JointRotations from = rotations_of(a);
  const JointRotations to = rotations_of(b);
  JointRotations mixed = from;
  mixed.root += share * (to.root - from.root);
  for (std::size_t i = 0; i < mixed.rotation.size(); ++i) {
    mixed.rotation[i] = from.rotation[i].slerp(share, to.rotation[i]);
  }
  for (std::size_t i = 0; i < mixed.elbow.size(); ++i) {
    mixed.elbow[i] += share * (to.elbow[i] - from.elbow[i]);
  }
  return pose_of(mixed, a);
}

HandMotions blend(const HandMotions& a, const HandMotions& b, double share) {
  HandMotions mixed = share < 0.5 ? a : b;
  for (std::size_t side = 0; side < 2; ++side) {
    for (std::size_t i = 0; i < kHandAngleCount; ++i) {
      mixed[side].angles[i] = a[side].angles[i] + share * (b[side].angles[i] - a[side].angles[i]);
    }
    if (a[side].seen && b[side].seen) {
      mixed[side].seen = a[side].seen->slerp(share, *b[side].seen);
    }
  }
  return mixed;
}

FaceMotion blend(const FaceMotion& a, const FaceMotion& b, double share) {
  FaceMotion mixed = a;
  mixed.confidence += share * (b.confidence - a.confidence);
  mixed.head = a.head.slerp(share, b.head);
  mixed.gaze += share * (b.gaze - a.gaze);
  for (std::size_t i = 0; i < kExpressionCount; ++i) {
    mixed.expressions[i] += share * (b.expressions[i] - a.expressions[i]);
  }
  return mixed;
}

}  // namespace

MotionFrame Resampler::between(const MotionFrame& a, const MotionFrame& b, double time) const {
  const double gap = b.time - a.time;
  const double share = gap > 0.0 ? std::clamp((time - a.time) / gap, 0.0, 1.0) : 1.0;
  if (share * gap >= gap - slack_) {
    return b;
  }
  if (gap <= longest_gap_ && a.state == TrackState::tracking && b.state == TrackState::tracking) {
    MotionFrame mixed = share < 0.5 ? a : b;
    if (a.hands && b.hands) {
      mixed.hands = blend(*a.hands, *b.hands, share);
    }
    if (a.face && b.face) {
      mixed.face = blend(*a.face, *b.face, share);
    }
    return with_pose(mixed, blend(a.pose, b.pose, share), body_, camera_);
  }
  MotionFrame held = a;
  if (gap > longest_gap_) {
    held.state = TrackState::lost;
    held.face.reset();
  }
  return held;
}

void Resampler::push(const MotionFrame& frame, const std::function<void(const MotionFrame&)>& take) {
  if (!last_) {
    start_ = frame.time;
    last_ = frame;
  }
  while (start_ + static_cast<double>(count_) / fps_ <= frame.time + slack_) {
    const double time = static_cast<double>(count_) / fps_;
    MotionFrame made = between(*last_, frame, start_ + time);
    made.frame = count_++;
    made.time = time;
    take(made);
  }
  last_ = frame;
}

}  // namespace telemime
