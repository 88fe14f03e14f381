// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "telemime/core/random.h"
#include "telemime/tracking/context.h"

namespace telemime {

/// Settings of the joint search over many frames (Config::look_back); the table (settings_of) gives the
/// meaning, unit and range of each.
struct TrajectoryConfig {
  int stretch = 100;
  int overlap = 25;
  int arms = 5;
  int kept = 16;
  double motion = 0.06;
  int sweeps = 2;
  int evaluations = 600;
  double between = 0.2;
};

SettingTable settings_of(TrajectoryConfig& config);

/// One frame of a window, with the poses that searches forward and backward in time found.
struct TrajectoryFrame {
  PreparedFrame frame;
  double heading = 0.0;  ///< predicted torsion of the root, rad
  std::vector<Pose>
      candidates;           ///< those of the forward search, its estimate first; then of the backward one
  std::size_t forward = 1;  ///< number of candidates of the forward search
  double time_step = 1.0;   ///< 1/25 s since the frame before, within the bounds of steps_between()
};

/// Inputs that are the same for all frames of a stretch.
struct TrajectoryContext {
  const Model& model;
  const JointLimits& limits;
  const RegistrationConfig& search;
  const TrajectoryConfig& config;
  Evaluators& evaluators;
};

/// Candidate poses of a frame with their costs without the neighbouring frames, the cheapest first: those of
/// the searches, the estimate's flips in depth, and the arms of all these combined on the trunks of the
/// cheapest pose and of both estimates.
std::vector<ScoredPose> combine(const TrajectoryContext& context, const TrajectoryFrame& frame,
                                Backend& backend);

/// Indices of the cheapest sequence of poses, one per frame (Viterbi): the costs of the poses and of the
/// steps between them, from `before` (may be null) on. `motion`: the cost of the step to each frame, one per
/// frame. No frame may be empty.
std::vector<std::size_t> cheapest_path(const Body& body, std::span<const std::vector<ScoredPose>> frames,
                                       std::span<const double> motion, const Pose* before);

/// One pose for each frame: the cheapest path, whose poses are then searched again with their neighbours as
/// the prior. `before` is the pose in the frame before the first; null: there is none. What a step costs
/// falls with its time, as the variance of a random walk grows. The result does not depend on the number of
/// threads.
std::vector<Pose> best_trajectory(const TrajectoryContext& context, std::span<const TrajectoryFrame> frames,
                                  const Pose* before, Random& random);

}  // namespace telemime
