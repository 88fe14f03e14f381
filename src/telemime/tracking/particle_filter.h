// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
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

/// Particle filter over poses (thesis 4.4): CONDENSATION with heuristics that are switched on by name. The
/// same seed and frames give the same result for any number of threads.
class ParticleFilter {
 public:
  /// `search` configures the local search of FilterConfig::blocks. `limits` and `evaluators` must outlive the
  /// filter. Throws Error(config).
  ParticleFilter(const FilterConfig& config, const RegistrationConfig& search, const JointLimits& limits,
                 Evaluators& evaluators, std::uint64_t seed);

  /// Starts with one particle at the pose of the frame before the first step. `backward`: frames come in
  /// reverse order of time, so that a person who walks looks where they come from.
  void start(const Pose& pose, bool backward = false);
  /// Removes all particles.
  void stop() { particles_.clear(); }
  bool started() const { return !particles_.empty(); }

  /// Estimates the pose in one frame. Throws Error(usage) before start(), and for an effort or a time step
  /// out of range.
  FilterResult step(const StepInput& input);

  /// Particles of the last frame, with normalised weights. `parent` is an index into the generation before,
  /// or into the modes to which that was merged.
  const std::vector<Particle>& particles() const { return particles_; }
  const FilterModel& numbers() const { return numbers_; }

 private:
  void run(Stage stage, const FilterContext& context, Generation& generation) const;

  FilterConfig config_;
  RegistrationConfig search_;
  const JointLimits& limits_;
  Evaluators& evaluators_;
  FilterModel numbers_;
  std::vector<const Heuristic*> heuristics_;
  Random seeds_;
  std::vector<Particle> particles_;
  Pose estimate_;
  Pose before_;
  bool backward_ = false;
  double time_step_before_ = 1.0;                       ///< 1/25 s from before_ to estimate_
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  ///< of the root, m in 1/25 s, smoothed
  cv::Mat labels_before_;
};

/// The estimate, then the best pose of each mode of the filter (FilterConfig::modes, mode_radius).
std::vector<Pose> mode_poses(const FilterConfig& config, const ParticleFilter& filter, const Body& body,
                             const Pose& estimate);

}  // namespace telemime
