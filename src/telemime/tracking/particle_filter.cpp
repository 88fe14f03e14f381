// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/particle_filter.h"

#include <algorithm>
#include <cmath>

#include "telemime/core/errors.h"
#include "telemime/tracking/heuristics/all.h"
#include "telemime/tracking/posterior.h"
#include "telemime/tracking/resampling.h"
#include "telemime/tracking/search_space.h"

namespace telemime {
namespace {

// Resampling of CONDENSATION (thesis 4.2.3), used when no heuristic resamples.
void resample_at_random(const FilterContext& context, Generation& generation) {
  std::vector<double> weights;
  for (const Particle& p : generation.parents) {
    weights.push_back(p.weight);
  }
  Random random = context.random(purpose::kResampling);
  generation.counts = multinomial_counts(weights, context.config.particles, random);
}

// Makes the children that are left, each diffused from its parent (thesis 4.4.1.3).
void diffuse(const FilterContext& context, Generation& generation) {
  std::vector<std::pair<std::size_t, std::size_t>> families;  // parent, first child
  std::size_t at = generation.particles.size();
  for (std::size_t i = 0; i < generation.counts.size(); ++i) {
    if (generation.counts[i] > 0) {
      families.emplace_back(i, at);
      at += static_cast<std::size_t>(generation.counts[i]);
    }
  }
  generation.particles.resize(at);
  const std::size_t best = heaviest(generation.parents);
  context.evaluators.each(families.size(), [&](std::size_t f, Backend&) {
    const auto [parent, first] = families[f];
    const Pose& from = generation.parents[parent].pose;
    const SearchSpace space = search_space(context, from, generation.moving, generation.end_effector);
    for (int c = 0; c < generation.counts[parent]; ++c) {
      const std::size_t index = first + static_cast<std::size_t>(c);
      Particle& child = generation.particles[index];
      const bool kept = generation.keep_best && parent == best && c == 0;
      Random random = context.random(purpose::kDiffusion, index);
      child.pose = kept ? from : diffused(context, space, random);
      child.origin = kept ? Origin::kept : Origin::diffused;
      child.parent = static_cast<int>(parent);
      child.prior = 1.0 / context.config.particles;
    }
  });
}

// Continues the motion of every parent: of its arms, the trunk stays. A pose is compared with the past of its
// own hypothesis: compared with that of the best one, the others would pay for the jump in each frame and
// never win.
void predict(const StepInput& input, double time_step_before, std::span<const Particle> parents,
             FilterContext& context) {
  const double share = share_of_motion(input.velocity, input.time_step, time_step_before);
  const auto after = [&](const Particle& parent) {
    return predict_pose(parent.pose, parent.before, share, time_step_before, context.limits);
  };
  context.predicted = after(parents[heaviest(parents)]);
  if (context.config.temporal > 0.0) {
    for (const Particle& parent : parents) {
      context.predicted_joints.push_back(forward_kinematics(input.model.body, after(parent)).joints);
    }
  }
}

// Removes the lightest particles until `count` remain.
void drop_lightest(std::size_t count, std::vector<Particle>& particles) {
  if (particles.size() <= count) {
    return;
  }
  weigh(particles);
  std::stable_sort(particles.begin(), particles.end(),
                   [](const Particle& a, const Particle& b) { return a.weight > b.weight; });
  particles.resize(count);
}

constexpr double kVelocityRate = 0.2;  // of the smoothed velocity, in 1/25 s

// Torsion of the root (rad) that a walking velocity (m in 1/25 s) suggests; 0 for a person who stands.
double heading_of(const Eigen::Vector3d& velocity) {
  constexpr double kStands = 0.008;  // 0.2 m/s
  constexpr double kWalks = 0.016;
  const double speed = std::hypot(velocity.x(), velocity.z());
  const double share = std::clamp((speed - kStands) / (kWalks - kStands), 0.0, 1.0);
  // A person who steps back still looks at the camera: at most side on.
  return share > 0.0 ? share * std::atan2(velocity.x(), std::abs(velocity.z())) : 0.0;
}

void check(const StepInput& input) {
  if (!(input.effort > 0.0 && input.effort <= 1.0)) {
    throw Error(ErrorKind::usage, "the effort of the particle filter must be above 0 and at most 1");
  }
  if (!(input.time_step > 0.0 && std::isfinite(input.time_step))) {
    throw Error(ErrorKind::usage, "the time step of the particle filter must be above 0");
  }
}

}  // namespace

ParticleFilter::ParticleFilter(const FilterConfig& config, const RegistrationConfig& search,
                               const JointLimits& limits, Evaluators& evaluators)
    : config_(config),
      search_(search),
      limits_(limits),
      evaluators_(evaluators),
      numbers_(load_filter_model(config.model, evaluators.cues())),
      heuristics_(parse_heuristics(config.heuristics)) {
  check_settings(config_);
}

void start_filter(const Pose& pose, const JointLimits& limits, FilterState& state, bool backward) {
  Particle particle;
  particle.pose = limits.clamp(pose);
  particle.before = particle.pose;
  particle.weight = particle.prior = 1.0;
  state.particles = {particle};
  state.estimate = particle.pose;
  state.time_step_before = 1.0;
  state.backward = backward;
  state.velocity.setZero();
  state.labels_before.release();
}

void ParticleFilter::run(Stage stage, const FilterContext& context, Generation& generation) const {
  for (const Heuristic* heuristic : heuristics_) {
    if (heuristic->stage == stage) {
      heuristic->run(context, generation);
    }
  }
}

FilterResult ParticleFilter::step(const StepInput& input, FilterState& state) const {
  if (state.particles.empty()) {
    throw Error(ErrorKind::usage, "the particle filter was not started");
  }
  check(input);
  const double frames = input.time_step;

  const FilterConfig enough = input.frame.landmarks ? with_landmarks(config_) : config_;
  const FilterConfig config = for_time_step(with_effort(enough, input.effort), frames);
  const RegistrationConfig search = for_time_step(search_, frames);
  FilterContext context{
      .frame = input.frame,
      .labels_before = state.labels_before.empty() ? nullptr : &state.labels_before,
      .model = input.model,
      .limits = limits_,
      .config = config,
      .numbers = numbers_,
      .search = search,
      .estimate = state.estimate,
      .heading = input.heading.value_or(heading_of(state.backward ? -state.velocity : state.velocity)),
      .evaluators = evaluators_,
      .seed = state.seeds.bits(),
      .time_step = frames};
  Generation generation;
  generation.parents = std::move(state.particles);

  // Predict: the arms continue their last motion; who walks looks where they go.
  run(Stage::merge, context, generation);
  predict(input, state.time_step_before, generation.parents, context);

  // Resample: how many children each parent has (thesis 4.2.3; equation 4.14 with the heuristic wd).
  run(Stage::resample, context, generation);
  if (generation.counts.empty()) {
    resample_at_random(context, generation);
  }

  // Propose: children by local search, the others by diffusion (equation 4.13) of the parts that move.
  run(Stage::partition, context, generation);
  run(Stage::optimise, context, generation);
  run_searches(context, generation);
  const std::size_t searched = generation.particles.size();
  diffuse(context, generation);

  // Score: likelihood of each child (equation 4.12); then flipped copies of the best ones replace the
  // lightest.
  measure(context, generation.particles);
  const std::size_t count = generation.particles.size();
  run(Stage::flip_candidates, context, generation);
  measure(context, generation.particles);
  FilterResult result;
  result.evaluations = generation.evaluations + static_cast<int>(generation.particles.size() - searched);
  drop_lightest(count, generation.particles);
  weigh(generation.particles);
  state.particles = std::move(generation.particles);

  // Choose: the heaviest particle or the weighted mean.
  for (Particle& particle : state.particles) {
    particle.before = generation.parents[static_cast<std::size_t>(particle.parent)].pose;
  }
  const Particle& best = state.particles[heaviest(state.particles)];
  const Pose before = state.estimate;
  state.estimate = best.pose;
  result.score = best.score;
  if (config_.estimate == "mean") {
    state.estimate = limits_.clamp(mean_pose(state.particles));
    evaluators_.evaluate(input.frame, input.model, {&state.estimate, 1}, {&result.score, 1});
    ++result.evaluations;
  }

  // Remember what the next prediction needs.
  const double rate = frames == 1.0 ? kVelocityRate : 1.0 - std::pow(1.0 - kVelocityRate, frames);
  state.velocity += rate * ((state.estimate.root - before.root) / frames - state.velocity);
  state.time_step_before = frames;
  input.frame.labels.copyTo(state.labels_before);
  result.pose = state.estimate;
  result.effective_particles = effective_sample_size(state.particles);
  result.moving = generation.moving;
  result.heading = context.heading;
  return result;
}

std::vector<Pose> mode_poses(const FilterConfig& config, std::span<const Particle> particles,
                             const Body& body, const Pose& estimate) {
  std::vector<Pose> poses = {estimate};
  for (const Mode& mode :
       find_modes(body, particles, config.mode_radius, static_cast<std::size_t>(config.modes))) {
    poses.push_back(particles[mode.likeliest].pose);
  }
  return poses;
}

}  // namespace telemime
