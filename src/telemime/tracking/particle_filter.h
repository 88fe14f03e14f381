// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "telemime/tracking/context.h"
#include "telemime/tracking/heuristics/heuristic.h"

namespace telemime {

/// Input of one step of the filter.
struct StepInput {
  const PreparedFrame& frame;
  const Model& model;
  double velocity = 0.0;  ///< share (0 to 1) of the arms' last motion that is predicted to continue
  /// rad, predicted torsion of the root; without it the filter derives it from the way the person walks.
  std::optional<double> heading = std::nullopt;
  double effort = 1.0;     ///< share (above 0, at most 1) of the configuration's evaluations
  double time_step = 1.0;  ///< 1/25 s since the frame before
};

/// Result of one step of the filter.
struct FilterResult {
  Pose pose;  ///< the estimate
  Score score;
  int evaluations = 0;
  double effective_particles = 0.0;
  PartSet moving;
  double heading = 0.0;  ///< rad, the predicted torsion of the root that the step used
};

/// What the filter carries from frame to frame: plain data, so that a copy is a snapshot.
struct FilterState {
  explicit FilterState(std::uint64_t seed = 1) : seeds(seed) {}
  bool started() const { return !particles.empty(); }

  /// Particles of the last frame, with normalised weights. `parent` is an index into the generation before,
  /// or into the modes to which that was merged.
  std::vector<Particle> particles;
  Pose estimate;                                       ///< in the last frame
  double time_step_before = 1.0;                       ///< 1/25 s from the frame before that
  bool backward = false;                               ///< the frames come against the order of time
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< of the root, m in 1/25 s, smoothed
  cv::Mat labels_before;                               ///< of the last frame
  Random seeds;  ///< one draw a frame, from which the frame's own generators start
};

/// Puts all particles at one pose, in the frame that comes next or before. `backward`: the frames come
/// against the order of time, so that a person who walks looks where they come from.
void start_filter(const Pose& pose, const JointLimits& limits, FilterState& state, bool backward = false);

/// Particle filter over poses (thesis 4.4): CONDENSATION with heuristics that are switched on one by one. It
/// holds what stays the same; FilterState holds the particles. The same seed and frames give the same result,
/// for any number of threads.
class ParticleFilter {
 public:
  /// `search` is for the local search of FilterConfig::blocks. `evaluators` must outlive the filter. Throws
  /// Error(config), Error(usage).
  ParticleFilter(const FilterConfig& config, const RegistrationConfig& search, const JointLimits& limits,
                 Evaluators& evaluators);

  /// Estimates the pose in one frame. Throws Error(usage) before start_filter(), and for an effort or a time
  /// step out of range.
  FilterResult step(const StepInput& input, FilterState& state) const;

  const FilterModel& numbers() const { return numbers_; }

 private:
  void run(Stage stage, const FilterContext& context, Generation& generation) const;

  FilterConfig config_;
  RegistrationConfig search_;
  JointLimits limits_;
  Evaluators& evaluators_;
  FilterModel numbers_;
  std::vector<const Heuristic*> heuristics_;
};

/// The best poses of the particles' modes (FilterConfig::modes, mode_radius), the estimate first.
std::vector<Pose> mode_poses(const FilterConfig& config, std::span<const Particle> particles,
                             const Body& body, const Pose& estimate);

}  // namespace telemime
