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

// The pose of a proposal, searched with all cues.
Particle search_further(const FilterContext& context, Particle particle, std::size_t index,
                        Backend& backend) {
  const int effort = context.config.landmark_evaluations;
  Objective objective(backend, context.frame, context.model, context.limits,
                      prior_at(context.model.body, particle.pose, context.heading));
  RegistrationConfig search = context.search;
  search.iterations = effort;
  search.proposals = no_proposals();
  Random random = context.random(purpose::kLandmarkSearch, index);
  const RegistrationResult found = register_pose(objective, particle.pose, search, random);
  particle.pose = found.pose;
  particle.score = found.score;
  particle.log_likelihood = log_likelihood(context, found.pose, found.score, particle.parent);
  particle.prior = static_cast<double>(effort) / context.config.particles;
  particle.origin = Origin::optimised;
  return particle;
}

}  // namespace

void search_landmarks(const FilterContext& context, Generation& generation) {
  const auto& landmarks = context.frame.landmarks;
  if (!landmarks) {
    return;
  }
  const Body& body = context.model.body;
  // Poses that continue the motion, and poses that the landmarks alone suggest.
  const auto proposals = [&](const LandmarkPrior& prior, std::size_t most) {
    return landmark_proposals(body, context.frame.camera, *landmarks, prior, context.limits, most);
  };
  std::vector<LandmarkFit> fits;
  std::vector<LandmarkFit> others;
  context.evaluators.each(2, [&](std::size_t i, Backend&) {
    if (i == 0) {
      fits = proposals({.pose = context.predicted, .following = kFollowing * std::sqrt(context.time_step)},
                       kMostFollowed);
    } else if (const auto alone =
                   pose_from_landmarks(body, context.frame.camera, *landmarks, context.limits)) {
      others = proposals({.pose = *alone}, kMostNew);
    }
  });
  fits.insert(fits.end(), others.begin(), others.end());
  std::vector<Particle> made(fits.size());
  for (std::size_t i = 0; i < fits.size(); ++i) {
    made[i].pose = fits[i].pose;
    made[i].parent = static_cast<int>(heaviest(generation.parents));
    made[i].prior = 1.0 / context.config.particles;
    made[i].origin = Origin::elsewhere;
  }
  measure(context, made);
  // The likeliest, searched further by all cues.
  std::stable_sort(made.begin(), made.end(),
                   [](const Particle& a, const Particle& b) { return a.log_likelihood > b.log_likelihood; });
  const int effort = context.config.landmark_evaluations;
  const auto searched =
      effort > 1 ? std::min(made.size(), static_cast<std::size_t>(context.config.landmark_searches)) : 0;
  for (std::size_t i = 0; i < searched; ++i) {
    generation.searches.push_back(
        {.run = [&context, i, from = made[i]](Backend& backend) -> std::vector<Particle> {
           return {search_further(context, from, i, backend)};
         },
         .evaluations = effort});
  }
  // The others as they are, after those that are searched.
  made.erase(made.begin(), made.begin() + static_cast<std::ptrdiff_t>(searched));
  generation.evaluations += static_cast<int>(searched);
  generation.searches.push_back({.run = [made](Backend&) { return made; }});
}

}  // namespace telemime
