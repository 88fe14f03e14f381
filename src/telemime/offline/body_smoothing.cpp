// SPDX-License-Identifier: Apache-2.0
#include "telemime/offline/body_smoothing.h"

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

using Quaternion = Eigen::Matrix<double, 1, 4>;
using Number = Eigen::Matrix<double, 1, 1>;

}  // namespace

JointRotations smoothed_first(const FileSmoothing& options, const std::deque<MeasuredPose>& poses,
                              std::optional<BodyState>& before) {
  JointRotations result;
  BodyState state = before.value_or(BodyState{});
  result.root = smooth<3>(
      options.root, poses, before, state.root,
      [](const MeasuredPose& pose) { return IntervalSample<3>{.value = pose.rotations.root.transpose()}; },
      [](const Eigen::RowVector3d& value, const auto& /*last*/) { return value; });
  for (std::size_t j = 0; j < result.rotation.size(); ++j) {
    const Quaternion twice = smooth<4>(
        options.angles, poses, before, state.rotation[j],
        [j](const MeasuredPose& pose) {
          return IntervalSample<4>{.value = 2.0 * pose.rotations.rotation[j].coeffs().transpose(),
                                   .ratio = pose.noise.rotation[j]};
        },
        // A quaternion and its negative are one rotation.
        [](const Quaternion& value, const Quaternion& last) {
          return Quaternion(value.dot(last) < 0.0 ? -value : value);
        });
    result.rotation[j].coeffs() = twice.normalized().transpose();
  }
  for (std::size_t side = 0; side < result.elbow.size(); ++side) {
    result.elbow[side] = smooth<1>(
        options.angles, poses, before, state.elbow[side],
        [side](const MeasuredPose& pose) {
          return IntervalSample<1>{.value = Number(pose.rotations.elbow[side]),
                                   .ratio = pose.noise.elbow[side]};
        },
        [](const Number& value, const Number& last) {
          return Number(last[0] + wrap_angle(value[0] - last[0]));
        })[0];
  }
  state.time = poses.front().time;
  before = state;
  return result;
}

}  // namespace telemime
