// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/landmark_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "telemime/search/landmark_fit.h"

namespace telemime {
namespace {

constexpr double kFollowing = 0.12;       // m, of elbows and wrists in 1/25 s; it grows as a random walk
constexpr std::size_t kMostFollowed = 4;  // proposals about the prediction
constexpr std::size_t kMostNew = 4;       // proposals from the landmarks alone

}  // namespace

void search_landmarks(const FilterContext& context, Generation& generation) {
  const auto& landmarks = context.frame.landmarks;
  if (!landmarks) {
    return;
  }
  const Body& body = context.model.body;
  // Poses that continue the motion, and poses that the landmarks alone suggest.
  std::vector<LandmarkFit> fits =
      landmark_proposals(body, context.frame.camera, *landmarks,
                         {.pose = context.predicted, .following = kFollowing * std::sqrt(context.time_step)},
                         context.limits, kMostFollowed);
  if (const auto alone = pose_from_landmarks(body, context.frame.camera, *landmarks, context.limits)) {
    const auto others = landmark_proposals(body, context.frame.camera, *landmarks, {.pose = *alone},
                                           context.limits, kMostNew);
    fits.insert(fits.end(), others.begin(), others.end());
  }
  std::vector<Particle> made(fits.size());
  for (std::size_t i = 0; i < fits.size(); ++i) {
    made[i].pose = fits[i].pose;
    made[i].parent = static_cast<int>(heaviest(generation.parents));
    made[i].prior = 1.0 / context.config.particles;
    made[i].origin = Origin::elsewhere;
  }
  measure(context, made);
  generation.evaluations += static_cast<int>(made.size());
  // The likeliest, searched further by all cues.
  std::stable_sort(made.begin(), made.end(),
                   [](const Particle& a, const Particle& b) { return a.log_likelihood > b.log_likelihood; });
  const auto searched = std::min(made.size(), static_cast<std::size_t>(context.config.landmark_searches));
  const int effort = context.config.landmark_evaluations;
  context.evaluators.each(effort > 1 ? searched : 0, [&](std::size_t i, Backend& backend) {
    Particle& particle = made[i];
    Objective objective(backend, context.frame, context.model, context.limits,
                        prior_at(body, particle.pose, context.heading));
    RegistrationConfig search = context.search;
    search.iterations = effort;
    search.proposals = no_proposals();
    Random random = context.random(purpose::kLandmarkSearch, i);
    const RegistrationResult found = register_pose(objective, particle.pose, search, random);
    particle.pose = found.pose;
    particle.score = found.score;
    particle.log_likelihood = log_likelihood(context, found.pose, found.score, particle.parent);
    particle.prior = static_cast<double>(effort) / context.config.particles;
    particle.origin = Origin::optimised;
  });
  generation.evaluations += effort > 1 ? static_cast<int>(searched) * effort : 0;
  generation.particles.insert(generation.particles.end(), made.begin(), made.end());
}

}  // namespace telemime
