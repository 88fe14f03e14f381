// SPDX-License-Identifier: Apache-2.0
#include "telemime/smoothing/two_way_smoother.h"

#include <ranges>

#include "telemime/core/errors.h"
#include "telemime/smoothing/joint_rotations.h"

namespace telemime {
namespace {

Pose middle(const Pose& a, const Pose& b) {
  JointRotations r = rotations_of(a);
  const JointRotations other = rotations_of(b);
  r.root = 0.5 * (r.root + other.root);
  for (std::size_t j = 0; j < r.rotation.size(); ++j) {
    r.rotation[j] = r.rotation[j].slerp(0.5, other.rotation[j]).normalized();
  }
  for (std::size_t side = 0; side < 2; ++side) {
    r.elbow[side] = 0.5 * (r.elbow[side] + other.elbow[side]);
  }
  return pose_of(r, a);
}

}  // namespace

TwoWaySmoother::TwoWaySmoother(const SmoothingOptions& options, const Body& body, const Camera& camera)
    : options_(options), body_(body), camera_(camera), forward_(make_smoother(options, body, camera)) {
  if (options.look_ahead < 0 || options.look_ahead > kLongestLookAhead) {
    throw Error(ErrorKind::config, "smoothing looks ahead between 0 and " +
                                       std::to_string(kLongestLookAhead) + " frames, not " +
                                       std::to_string(options.look_ahead));
  }
}

void TwoWaySmoother::push(const MotionFrame& frame) {
  waiting_.push_back({frame, (*forward_)(frame)});
}

std::optional<MotionFrame> TwoWaySmoother::next() {
  const auto ahead = static_cast<std::size_t>(options_.look_ahead);
  if (waiting_.empty() || (!finished_ && waiting_.size() <= ahead)) {
    return std::nullopt;
  }
  const Waiting front = waiting_.front();
  MotionFrame result = front.forward;
  if (ahead > 0 && front.measured.state == TrackState::tracking) {
    const auto backward = make_smoother(options_, body_, camera_);
    MotionFrame seen_back;
    for (const Waiting& later : std::ranges::reverse_view(waiting_)) {
      MotionFrame reversed = later.measured;
      reversed.time = -reversed.time;
      seen_back = (*backward)(reversed);
    }
    if (front.forward.pose.vector().allFinite() && seen_back.pose.vector().allFinite()) {
      result = with_pose(front.measured, middle(front.forward.pose, seen_back.pose), body_, camera_);
    }
  }
  waiting_.pop_front();
  return result;
}

}  // namespace telemime
