// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/two_way_smoothing.h"

#include <algorithm>

#include "telemime/core/time_base.h"

namespace telemime {
namespace {

std::optional<MeasuredPose> measured_pose(const MotionFrame& motion, const Camera& camera) {
  if (motion.state == TrackState::lost || !motion.pose.vector().allFinite()) {
    return std::nullopt;
  }
  return MeasuredPose{
      .time = motion.time, .rotations = rotations_of(motion.pose), .noise = noise_of(motion, camera)};
}

/// Takes the first measured pose and smooths it with those that follow it without a gap, `count` in all.
std::optional<JointRotations> next_body(TwoWaySmoothing& smoothing, std::size_t count) {
  std::deque<MeasuredPose> poses;
  for (const auto& pose : smoothing.measured) {
    if (poses.size() == count || !pose ||
        (!poses.empty() && !are_neighbours(poses.back().time, pose->time))) {
      break;
    }
    poses.push_back(*pose);
  }
  smoothing.measured.pop_front();
  if (poses.empty()) {
    smoothing.before.reset();
    return std::nullopt;
  }
  if (smoothing.before && !are_neighbours(smoothing.before->time, poses.front().time)) {
    smoothing.before.reset();
  }
  return smoothed_first(smoothing.options.file, poses, smoothing.before);
}

}  // namespace

TwoWaySmoothing make_two_way_smoothing(const SmoothingOptions& options, const Body& body,
                                       const Camera& camera) {
  return {.options = options,
          .body = body,
          .camera = camera,
          .forward = make_smoother(options, body, camera),
          .measured = {},
          .before = {}};
}

void smooth_forward(TwoWaySmoothing& smoothing, RecordQueue& queue) {
  for (; queue.smoothed < queue.chosen; ++queue.smoothed) {
    MotionFrame& motion = queue.records[queue.smoothed].estimate.motion;
    smoothing.measured.push_back(measured_pose(motion, smoothing.camera));
    motion = (*smoothing.forward)(motion);
  }
}

std::optional<MotionFrame> smoothed_front(TwoWaySmoothing& smoothing, const RecordQueue& queue, bool last) {
  if (queue.smoothed == 0) {
    return std::nullopt;
  }
  MotionFrame result = queue.records.front().estimate.motion;
  const double time = result.time;
  // Until the first frame at the end of the look-ahead.
  const double until = time + kTimeUnit * (smoothing.options.look_ahead - 0.01);
  const auto smoothed_end = queue.records.begin() + static_cast<std::ptrdiff_t>(queue.smoothed);
  const auto at_end = std::find_if(queue.records.begin(), smoothed_end, [until](const FrameRecord& record) {
    return record.estimate.motion.time >= until;
  });
  if (at_end == smoothed_end && !last) {
    return std::nullopt;
  }
  if (smoothing.options.look_ahead == 0) {
    smoothing.measured.pop_front();
    return result;
  }
  const auto ahead = static_cast<std::size_t>(at_end - queue.records.begin());
  const std::size_t count = std::min(queue.smoothed, ahead + 1);
  const auto backward = make_smoother(smoothing.options, smoothing.body, smoothing.camera);
  for (std::size_t i = count; i-- > 0;) {
    result = queue.records[i].estimate.motion;
    result.time = -result.time;
    result = (*backward)(result);
  }
  result.time = time;
  const auto rotations = next_body(smoothing, count);
  if (rotations && smoothing.options.name == "one-euro") {
    result = with_pose(result, pose_of(*rotations, result.pose), smoothing.body, smoothing.camera);
  }
  return result;
}

}  // namespace telemime
