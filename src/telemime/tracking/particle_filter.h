// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "telemime/tracking/context.h"
#include "telemime/tracking/generation.h"
#include "telemime/tracking/heuristics/heuristic.h"

namespace telemime {

/// What one frame gave.
struct FilterResult {
  Pose pose;  ///< the estimate
  Score score;
  int evaluations = 0;
  double effective_particles = 0.0;
  PartSet moving;
  double facing = 0.0;  ///< FilterContext::facing
};

/// Particle filter over poses (thesis 4.4): CONDENSATION with heuristics that are switched on one by one. The
/// same seed and frames give the same result, for any number of threads.
class ParticleFilter {
 public:
  /// `search` is for the local search of FilterConfig::blocks. Throws Error(config), Error(usage).
  ParticleFilter(const FilterConfig& config, const RegistrationConfig& search, const JointLimits& limits,
                 Evaluators& evaluators, std::uint64_t seed);

  /// All particles at one pose, in the frame that comes next or before. `backward`: the frames come against
  /// the order of time, and who walks looks where they come from.
  void start(const Pose& pose, bool backward = false);
  /// Forgets all particles.
  void stop() { particles_.clear(); }
  bool started() const { return !particles_.empty(); }

  /// From the next frame on: a share (above 0, at most 1) of the configuration's evaluations.
  void set_effort(double share);
  /// The next frame comes so many times 1/25 s after the one before; 1 until it is set, and after start().
  void set_time_step(double frames);

  /// One frame. Must have been started. `velocity`: share of the last motion that is expected again.
  /// `facing`: FilterContext::facing, where it is known better than from the root's way.
  FilterResult step(const PreparedFrame& frame, const Model& model, double velocity,
                    std::optional<double> facing = std::nullopt);

  /// Of the last frame, weights normalised; `parent` is an index of the generation before, or of the modes
  /// that it was merged to.
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
  double effort_ = 1.0;
  bool backward_ = false;
  double frames_ = 1.0;                                 ///< time step of the next frame
  double frames_before_ = 1.0;                          ///< from before_ to estimate_
  Eigen::Vector3d velocity_ = Eigen::Vector3d::Zero();  ///< of the root, m in 1/25 s, smoothed
  cv::Mat labels_before_;
};

/// The best poses of a filter's modes (FilterConfig::modes, mode_radius), the estimate first.
std::vector<Pose> mode_poses(const FilterConfig& config, const ParticleFilter& filter, const Body& body,
                             const Pose& estimate);

}  // namespace telemime
