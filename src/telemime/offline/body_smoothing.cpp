// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/body_smoothing.h"

#include <algorithm>
#include <vector>

#include "telemime/body/rotations.h"

namespace telemime {
namespace {

/// Smooths one quantity of the poses; `state` becomes what is known of it at the first. `sample_of` gives its
/// value in a pose. Where several values mean the same, `near` gives that which is nearest to another value.
template <int N, typename SampleOf, typename Near>
Eigen::Matrix<double, 1, N> smooth(const IntervalModel& model, const std::deque<MeasuredPose>& poses,
                                   const std::optional<BodyState>& before, IntervalState<N>& state,
                                   const SampleOf& sample_of, const Near& near) {
  std::vector<IntervalSample<N>> samples;
  samples.reserve(poses.size());
  double last_time = before ? before->time : poses.front().time;
  Eigen::Matrix<double, 1, N> last = before ? state.mean.row(0).eval() : sample_of(poses.front()).value;
  for (const MeasuredPose& pose : poses) {
    IntervalSample<N> sample = sample_of(pose);
    sample.value = near(sample.value, last);
    sample.step = pose.time - last_time;
    last = sample.value;
    last_time = pose.time;
    samples.push_back(sample);
  }
  std::optional<IntervalState<N>> known;
  if (before) {
    known = state;
  }
  const Eigen::Matrix<double, 1, N> result = smoothed_first<N>(model, samples, known);
  state = *known;
  return result;
}

using Number = Eigen::Matrix<double, 1, 1>;
using Quaternion = Eigen::Matrix<double, 1, 4>;

// Twice its coefficients: a small turn by an angle changes them by the angle.
Quaternion twice(const Eigen::Quaterniond& rotation) {
  return 2.0 * rotation.coeffs().transpose();
}

Eigen::Quaterniond rotation_of(const Quaternion& twice) {
  Eigen::Quaterniond rotation;
  rotation.coeffs() = twice.normalized().transpose();
  return rotation;
}

// A quaternion and its negative are one rotation.
Quaternion nearer_sign(const Quaternion& value, const Quaternion& last) {
  return value.dot(last) < 0.0 ? Quaternion(-value) : value;
}

SmoothedHand smoothed_hand(const FileSmoothing& options, const std::deque<MeasuredPose>& poses,
                           std::size_t side, const std::optional<BodyState>& before, HandInterval& state) {
  constexpr int kAngles = static_cast<int>(kHandAngleCount);
  using Angles = Eigen::Matrix<double, 1, kAngles>;
  const Angles angles = smooth<kAngles>(
      options.fingers, poses, before, state.angles,
      [side](const MeasuredPose& pose) {
        const MeasuredHand& hand = pose.hands[side];
        return IntervalSample<kAngles>{.value = Eigen::Map<const Angles>(hand.angles.data()),
                                       .ratio = hand.noise};
      },
      [](const Angles& value, const auto& /*last*/) { return value; });
  SmoothedHand result;
  for (std::size_t a = 0; a < kHandAngleCount; ++a) {
    const AngleRange& range = hand_limits()[a];
    result.angles[a] = std::clamp(angles[static_cast<Eigen::Index>(a)], range.min, range.max);
  }
  result.palm = rotation_of(smooth<4>(
      options.angles, poses, before, state.palm,
      [side](const MeasuredPose& pose) {
        const MeasuredHand& hand = pose.hands[side];
        return IntervalSample<4>{.value = twice(hand.palm), .ratio = hand.noise};
      },
      nearer_sign));
  return result;
}

}  // namespace

SmoothedPose smoothed_first(const FileSmoothing& options, const std::deque<MeasuredPose>& poses,
                            std::optional<BodyState>& before) {
  SmoothedPose result;
  JointRotations& body = result.rotations;
  BodyState state = before.value_or(BodyState{});
  body.root = smooth<3>(
      options.root, poses, before, state.root,
      [](const MeasuredPose& pose) { return IntervalSample<3>{.value = pose.rotations.root.transpose()}; },
      [](const Eigen::RowVector3d& value, const auto& /*last*/) { return value; });
  for (std::size_t j = 0; j < body.rotation.size(); ++j) {
    body.rotation[j] = rotation_of(smooth<4>(
        options.angles, poses, before, state.rotation[j],
        [j](const MeasuredPose& pose) {
          return IntervalSample<4>{.value = twice(pose.rotations.rotation[j]),
                                   .ratio = pose.noise.rotation[j]};
        },
        nearer_sign));
  }
  for (std::size_t side = 0; side < body.elbow.size(); ++side) {
    body.elbow[side] = smooth<1>(
        options.angles, poses, before, state.elbow[side],
        [side](const MeasuredPose& pose) {
          return IntervalSample<1>{.value = Number(pose.rotations.elbow[side]),
                                   .ratio = pose.noise.elbow[side]};
        },
        [](const Number& value, const Number& last) {
          return Number(last[0] + wrap_angle(value[0] - last[0]));
        })[0];
    result.hands[side] = smoothed_hand(options, poses, side, before, state.hands[side]);
  }
  state.time = poses.front().time;
  before = state;
  return result;
}

}  // namespace telemime
