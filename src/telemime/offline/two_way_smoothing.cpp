// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/two_way_smoothing.h"

#include <algorithm>

#include "telemime/body/arm_parts.h"
#include "telemime/core/time_base.h"

namespace telemime {
namespace {

// A hand that is seen at `time` was on its way there before: where it was not seen, it is the less surely at
// rest the nearer that is.
void loosen_before(double time, std::size_t side, TwoWaySmoothing& smoothing) {
  HandNoise noise;
  for (auto pose = smoothing.measured.rbegin(); pose != smoothing.measured.rend(); ++pose) {
    if (!*pose || (*pose)->hands[side].seen) {
      return;
    }
    MeasuredHand& hand = (*pose)->hands[side];
    noise.observe({}, time - (*pose)->time);
    hand.noise = std::max(hand.noise, noise.ratio());
    time = (*pose)->time;
  }
}

// What a frame says of the hands, `step` seconds after the one before it.
void measure_hands_of(const MotionFrame& motion, double step, TwoWaySmoothing& smoothing,
                      MeasuredPose& pose) {
  const Kinematics kinematics = forward_kinematics(smoothing.body, motion.pose);
  for (std::size_t side = 0; side < kArmParts.size(); ++side) {
    const HandMotion& hand = (*motion.hands)[side];
    HandNoise& noise = smoothing.hand_noise[side];
    noise.observe(hand, step);
    pose.hands[side] = {
        .angles = hand.angles,
        .palm = hand.seen.value_or(Eigen::Quaterniond(kinematics[kArmParts[side].hand].linear())),
        .noise = noise.ratio(),
        .seen = hand.visibility > 0.0,
    };
    if (pose.hands[side].seen) {
      loosen_before(pose.time, side, smoothing);
    }
  }
}

std::optional<MeasuredPose> measured_pose(TwoWaySmoothing& smoothing, const MotionFrame& motion) {
  if (motion.state == TrackState::lost || !motion.pose.vector().allFinite()) {
    smoothing.hand_noise = {};
    return std::nullopt;
  }
  MeasuredPose pose{.time = motion.time,
                    .rotations = rotations_of(motion.pose),
                    .noise = noise_of(motion, smoothing.camera)};
  if (motion.hands) {
    const auto& last = smoothing.measured;
    const bool follows = !last.empty() && last.back() && are_neighbours(last.back()->time, motion.time);
    measure_hands_of(motion, follows ? motion.time - last.back()->time : 0.0, smoothing, pose);
  }
  return pose;
}

/// Takes the first measured pose and smooths it with those that follow it without a gap, `count` in all.
std::optional<SmoothedPose> next_pose(TwoWaySmoothing& smoothing, std::size_t count) {
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

MotionFrame with_smoothed(const MotionFrame& frame, const SmoothedPose& smoothed,
                          const TwoWaySmoothing& smoothing) {
  MotionFrame result = frame;
  for (std::size_t side = 0; result.hands && side < result.hands->size(); ++side) {
    HandMotion& hand = (*result.hands)[side];
    hand.angles = smoothed.hands[side].angles;
    if (hand.seen) {
      hand.seen = smoothed.hands[side].palm;
    }
  }
  return with_pose(result, pose_of(smoothed.rotations, result.pose), smoothing.body, smoothing.camera);
}

}  // namespace

TwoWaySmoothing make_two_way_smoothing(const SmoothingOptions& options, const Body& body,
                                       const Camera& camera) {
  return {.options = options,
          .body = body,
          .camera = camera,
          .forward = make_smoother(options, body, camera),
          .measured = {},
          .before = {},
          .hand_noise = {}};
}

void smooth_forward(TwoWaySmoothing& smoothing, RecordQueue& queue) {
  for (; queue.smoothed < queue.chosen; ++queue.smoothed) {
    MotionFrame& motion = queue.records[queue.smoothed].estimate.motion;
    smoothing.measured.push_back(measured_pose(smoothing, motion));
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
  if (at_end == smoothed_end && !last && queue.smoothed < kMostWaiting) {
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
  const auto smoothed = next_pose(smoothing, count);
  return smoothed && smoothing.options.name == "one-euro" ? with_smoothed(result, *smoothed, smoothing)
                                                          : result;
}

}  // namespace telemime
