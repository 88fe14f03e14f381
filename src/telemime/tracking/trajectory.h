// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "telemime/core/random.h"
#include "telemime/tracking/context.h"

namespace telemime {

/// Settings of the search over many frames at once (`track --offline`).
struct TrajectoryConfig {
  int stretch = 100;  ///< frames that are decided together
  int overlap = 25;   ///< frames after them that are looked at, too
  int arms = 5;       ///< of each side that are combined with each other, in each frame
  int kept = 16;      ///< poses of a frame that the best way may go through
  /// What a step from frame to frame costs: of the squared way of elbows and wrists, as
  /// ObjectiveWeights::temporal.
  double motion = 0.06;
  int sweeps = 2;         ///< times that each pose is searched again between those beside it; 0: never
  int evaluations = 600;  ///< of each such search
  double between = 0.2;   ///< ObjectiveWeights::temporal of that search, toward the middle of its neighbours

  /// Throws Error(config) with what to change.
  void validate() const;
};

/// One frame of a stretch, with what searches that knew only the frames before it, or after it, found.
struct StretchFrame {
  PreparedFrame frame;
  double heading = 0.0;          ///< as in FilterContext
  std::vector<Pose> candidates;  ///< the first one is the filter's estimate
  std::size_t forward = 1;  ///< so many of them know only the frames before; then the estimate of the others
};

/// What does not change within a stretch.
struct TrajectoryContext {
  const Model& model;
  const JointLimits& limits;
  const RegistrationConfig& search;
  const TrajectoryConfig& config;
  Evaluators& evaluators;
};

/// The poses of a frame that a trajectory may go through, the cheapest first: the candidates, the estimate's
/// flips in depth, and the arms of all these on the trunks of the cheapest and of both estimates.
struct ScoredPose {
  Pose pose;
  double cost = 0.0;
};
std::vector<ScoredPose> combine(const TrajectoryContext& context, const StretchFrame& frame,
                                Backend& backend);

/// Indices of the cheapest way through the frames, one pose in each (Viterbi): the poses' own costs and those
/// of the steps between them, from `before` on when it is given. No frame may be empty.
std::vector<std::size_t> cheapest_way(const Body& body, std::span<const std::vector<ScoredPose>> frames,
                                      double motion, const Pose* before);

/// One pose for each frame: the cheapest way, each pose then searched again near the middle of those before
/// and after it. `before`: the pose in the frame before the first, null when there is none. The same
/// for any number of threads.
std::vector<Pose> best_trajectory(const TrajectoryContext& context,
                                  std::span<const StretchFrame* const> frames, const Pose* before,
                                  Random& random);

}  // namespace telemime
