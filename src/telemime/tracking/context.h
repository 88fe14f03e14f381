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

/// Back ends of the filter: one for batches, one for each thread that searches on its own.
class Evaluators {
 public:
  /// `threads` 0: as many as the machine has. Throws as make_backend does.
  Evaluators(const std::string& backend, int threads);

  /// All scores of all poses, in batches; does not depend on the number of threads.
  void evaluate(const PreparedFrame& frame, const Model& model, std::span<const Pose> poses,
                std::span<Score> scores);
  /// work(i, back end) for all i below `count`, on all threads. Exceptions come out.
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
  const Pose& predicted;             ///< prediction for this frame
  double heading = 0.0;  ///< rad, predicted torsion of the root: people who walk look where they go
  Evaluators& evaluators;
  std::uint64_t seed = 0;  ///< seed of this frame
  /// Joints of `predicted`, m, camera frame; computed once a frame rather than once a particle.
  JointPositions predicted_joints = forward_kinematics(model.body, predicted).joints;

  /// A generator of its own for each purpose and particle.
  Random random(std::uint64_t purpose, std::uint64_t index = 0) const;
};

/// log p(z | x) of equation 4.12 with what FilterConfig knows without the image.
double log_likelihood(const FilterContext& context, const Pose& pose, const Score& score);

/// Scores and log likelihoods of the particles that have none.
void measure(const FilterContext& context, std::span<Particle> particles);

}  // namespace telemime
