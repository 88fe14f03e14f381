// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "telemime/evaluation/truth.h"

namespace telemime {

/// Joints by frame number; nothing for a frame that does not count.
using JointTrack = std::vector<std::optional<TruthJoints>>;

/// Mean length of the second difference of both wrists, m/frame^2, over all three frames in a row that have
/// the wrist. Nothing when there are none.
std::optional<double> wrist_jitter(const JointTrack& track);

/// How many frames the estimate comes behind the truth.
struct Lag {
  double frames = 0.0;       ///< positive: late
  double correlation = 0.0;  ///< at that lag, in [-1, 1]
};

/// Peak of the normalised cross-correlation of the elbows' and wrists' coordinates (each with the mean taken
/// off), refined by a parabola through it and its neighbours. Nothing when the truth hardly moves (less than
/// 5 mm of standard deviation), when there are fewer than 10 common frames, or when the peak lies at the end
/// of the range [-longest, longest].
std::optional<Lag> lag_behind(const JointTrack& estimate, const JointTrack& truth, int longest = 15);

/// How well the direction of the trunk is followed: that of the line through the shoulders about the
/// vertical.
struct TurnReport {
  std::size_t frames = 0;  ///< with both shoulders in both tracks
  double error = 0.0;      ///< rad, mean of the sizes of the differences
  std::size_t turned = 0;  ///< frames in which the true line is at least 15 degrees from the image plane
  std::optional<double> error_turned;  ///< rad, the mean over these
  std::size_t wrong_way = 0;           ///< of these, frames in which the estimate is turned to the other side
};

/// Nothing when no frame has both shoulders.
std::optional<TurnReport> measure_turn(const JointTrack& estimate, const JointTrack& truth);

/// Length of one bone over a track.
struct BoneLength {
  double mean = 0.0;       ///< m
  double variation = 0.0;  ///< standard deviation over mean
};

inline constexpr std::array<std::string_view, 5> kBoneNames = {"shoulder_width", "l_upper_arm", "r_upper_arm",
                                                               "l_forearm", "r_forearm"};

/// By kBoneNames; nothing for a bone that is never seen whole.
std::array<std::optional<BoneLength>, kBoneNames.size()> bone_lengths(const JointTrack& track);

}  // namespace telemime
