// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "telemime/body/limits.h"
#include "telemime/search/objective.h"
#include "telemime/tracking/filter_config.h"
#include "telemime/tracking/filter_model.h"
#include "telemime/tracking/particle.h"

namespace telemime {

/// Streams of random numbers of one frame (FilterContext::random). Each purpose has its own, so that
/// switching a heuristic off does not change the draws of the others.
namespace purpose {
inline constexpr std::uint64_t kResampling = 1;
inline constexpr std::uint64_t kDiffusion = 2;
inline constexpr std::uint64_t kSimplex = 3;
inline constexpr std::uint64_t kHeadingSearch = 4;
inline constexpr std::uint64_t kLandmarkSearch = 5;
}  // namespace purpose

/// Back ends of the filter: one for batches and one for each thread that runs a local search.
class Evaluators {
 public:
  /// `threads` 0: as many as the machine has. Throws as make_backend does.
  Evaluators(const std::string& backend, int threads, const CueTable& cues = {});

  const CueTable& cues() const { return batch_->cues(); }
  /// Scores of all poses by all cues, in one batch; they do not depend on the number of threads. `kinematics`
  /// are those of the poses, where the caller has them.
  void evaluate(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses,
                std::span<Score> scores, std::span<const Kinematics> kinematics = {});
  /// Calls work(i, back end) for all i below `count`, on all threads, about in the order of i: each thread
  /// takes a few at a time. An exception is passed on, and what has not begun by then is left out.
  void each(std::size_t count, const std::function<void(std::size_t, Backend&)>& work);

 private:
  int threads_;
  std::unique_ptr<Backend> batch_;
  std::vector<std::unique_ptr<Backend>> singles_;
};

/// Everything that the filter's step reads in one frame. Keeps references: use it within that frame.
struct FilterContext {
  const PreparedFrame& frame;
  const cv::Mat* labels_before = nullptr;  ///< labels of the frame before; null: there is none
  const Model& model;
  const JointLimits& limits;
  const FilterConfig& config;
  const FilterModel& numbers;
  const RegistrationConfig& search;  ///< local search of FilterConfig::blocks
  const Pose& estimate;              ///< estimate of the frame before
  double heading = 0.0;  ///< rad, predicted torsion of the root: people who walk look where they go
  Evaluators& evaluators;
  std::uint64_t seed = 0;  ///< seed of this frame
  double time_step = 1.0;  ///< 1/25 s since the frame before
  Pose predicted = {};     ///< where the motion of the heaviest parent leads
  /// Joints where the motion of each parent leads, m, camera frame: every hypothesis has its own past, by
  /// which its children are judged. Empty where FilterConfig::temporal is 0.
  std::vector<JointPositions> predicted_joints = {};

  /// A separate generator for each purpose and particle.
  Random random(std::uint64_t purpose, std::uint64_t index = 0) const;
};

/// A squared error in standard deviations, as it counts where the standard deviation is that of pictures in
/// which the square is `usual`, and that of this picture is unknown (the negative log density of Student's t
/// distribution, but for a constant). Its derivative is 1 at `usual` and falls to 0 beyond.
double square_of_unknown_noise(double square, double usual);

/// Log likelihood log p(z | x): the sum over all enabled cues of thesis equation 4.12, and the terms that do
/// not depend on the image (FilterConfig::natural, temporal, invalid). `parent` is that of the particle. In
/// frames with landmarks the noise of a cue with FilterModel::usual is taken as unknown: where a room has the
/// colours of the person, F is large in every pose, and its differences say little.
double log_likelihood(const FilterContext& context, const Pose& pose, const Score& score, int parent);
/// The same; `kinematics` are those of the pose.
double log_likelihood(const FilterContext& context, const Pose& pose, const Score& score, int parent,
                      const Kinematics& kinematics);

/// Computes scores and log likelihoods of the particles that are not measured yet.
void measure(const FilterContext& context, std::span<Particle> particles);

}  // namespace telemime
