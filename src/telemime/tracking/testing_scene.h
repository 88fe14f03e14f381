// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "telemime/body/arm_ik.h"
#include "telemime/search/budget.h"
#include "telemime/tracking/particle_filter.h"

/// Small images of a person rendered from the model, for the tests of the filter. Not installed.
namespace telemime::testing_scene {

inline constexpr double kDegree = std::numbers::pi / 180.0;

/// Seated, both arms beside the body and fully visible.
inline Pose both_arms_seen() {
  Pose pose;
  pose.root = {0.0, 0.35, 1.5};
  set_arm_angles(pose, Side::left, {-20 * kDegree, 10 * kDegree, 50 * kDegree, -60 * kDegree});
  set_arm_angles(pose, Side::right, {-30 * kDegree, -10 * kDegree, -45 * kDegree, -70 * kDegree});
  return pose;
}

/// Everything to which a FilterContext refers.
struct Scene {
  Model model = make_model(Shape{});
  Camera camera = camera_from_field_of_view(120, 90, 60.0);
  JointLimits limits = anatomical_limits();
  FilterConfig config;
  FilterModel numbers = load_filter_model("");
  RegistrationConfig search;
  Evaluators evaluators{"scalar", 1};
  Pose estimate = both_arms_seen();
  Pose predicted = both_arms_seen();
  double heading = 0.0;
  PreparedFrame frame = frame_of_model(model, both_arms_seen(), camera);
  cv::Mat labels_before;

  /// Sets the frame to an image of the person in this pose.
  void show(const Pose& pose) { frame = frame_of_model(model, pose, camera); }
  FilterContext context(std::uint64_t seed = 1) {
    return {.frame = frame,
            .labels_before = labels_before.empty() ? nullptr : &labels_before,
            .model = model,
            .limits = limits,
            .config = config,
            .numbers = numbers,
            .search = search,
            .estimate = estimate,
            .heading = heading,
            .evaluators = evaluators,
            .seed = seed,
            .predicted = predicted,
            .predicted_joints = {joints(predicted)}};
  }
  JointPositions joints(const Pose& pose) const { return forward_kinematics(model.body, pose).joints; }
};

/// A filter with its particles.
struct RunningFilter {
  RunningFilter(const Scene& scene, const FilterConfig& config, Evaluators& evaluators, std::uint64_t seed)
      : method(config, scene.search, scene.limits, evaluators), limits(scene.limits), state(seed) {}
  void start(const Pose& pose, bool backward = false) { start_filter(pose, limits, state, backward); }
  FilterResult step(const StepInput& input) { return method.step(input, state); }
  const std::vector<Particle>& particles() const { return state.particles; }

  ParticleFilter method;
  JointLimits limits;
  FilterState state;
};

inline Particle particle(const Pose& pose, double weight, double log_likelihood = 0.0) {
  Particle p;
  p.pose = pose;
  p.weight = p.prior = weight;
  p.log_likelihood = log_likelihood;
  return p;
}

inline double mean_of(std::span<const double> values) {
  double sum = 0.0;
  for (const double v : values) {
    sum += v;
  }
  return sum / static_cast<double>(values.size());
}

/// Covariance of two lists of equal length.
inline double covariance_of(std::span<const double> a, std::span<const double> b) {
  const double mean_a = mean_of(a);
  const double mean_b = mean_of(b);
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += (a[i] - mean_a) * (b[i] - mean_b);
  }
  return sum / static_cast<double>(a.size());
}

inline double deviation_of(std::span<const double> values) {
  return std::sqrt(covariance_of(values, values));
}

}  // namespace telemime::testing_scene
