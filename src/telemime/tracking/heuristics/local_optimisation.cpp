// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/local_optimisation.h"

#include <algorithm>
#include <cmath>

#include "telemime/body/interpenetration.h"
#include "telemime/tracking/search_space.h"

namespace telemime {
namespace {

struct Job {
  int parent = 0;
  int evaluations = 0;
  int number = 0;  // among the jobs of the same parent
  bool proposes = false;
  int saved = 0;  // evaluations that a brief second search of this parent leaves out
};

// Weights of a metre of interpenetration beside F and beside D_C (pixels).
constexpr double kInsideRegion = 4.0;
constexpr double kInsideContour = 40.0;
// The simplex over the edges starts with this share of the one over the regions.
constexpr double kRestart = 0.2;

// F or D_C, each with a penalty for segments inside each other (thesis 3.5.4).
double cost_of(const Body& body, const Particle& particle, bool contour) {
  const double inside = interpenetration(body, forward_kinematics(body, particle.pose));
  return contour ? particle.score.contour() + kInsideContour * inside
                 : particle.score.region() + kInsideRegion * inside;
}

// Local search of the thesis: one simplex over all moving numbers, from diffused children. Every vertex
// becomes a particle.
std::vector<Particle> descend(const FilterContext& context, const Generation& generation, const Job& job,
                              Backend& backend) {
  const Particle& parent = generation.parents[static_cast<std::size_t>(job.parent)];
  const SearchSpace space = search_space(context, parent.pose, generation.moving, generation.end_effector);
  const Eigen::Index n = space.block.start.size();
  Random random = context.random(purpose::kSimplex, static_cast<std::uint64_t>(job.parent));
  Objective objective(backend, context.frame, context.model, context.limits);
  std::vector<Particle> children;
  const bool has_region = objective.cues()[cue::kRegion].enabled;
  const bool has_contour = objective.cues()[cue::kContour].enabled;
  bool contour = !has_region;
  const auto cost = [&](const Eigen::VectorXd& x) {
    Particle child;
    child.pose = context.limits.clamp(space.block.decode(x));
    child.score = objective.score(child.pose, objective.cues().needs());
    child.log_likelihood = log_likelihood(context, child.pose, child.score, job.parent);
    child.parent = job.parent;
    child.prior = 1.0 / context.config.particles;
    child.origin = Origin::optimised;
    child.measured = true;
    children.push_back(child);
    return cost_of(context.model.body, child, contour);
  };
  // The parent and n diffused children are the first simplex.
  std::vector<Eigen::VectorXd> start = {space.block.start};
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::VectorXd x = space.block.start;
    for (Eigen::Index j = 0; j < n; ++j) {
      x[j] = std::clamp(random.normal(x[j], space.block.steps[j]), space.block.bounds.low[j],
                        space.block.bounds.high[j]);
    }
    start.push_back(x);
  }
  // Minimise F, then D_C from the last simplex (thesis 3.5.4).
  SimplexOptions options;
  const int iterations = job.evaluations - static_cast<int>(n) - 1;
  const int edges = static_cast<int>(std::lround((1.0 - context.search.region_share) * iterations));
  const bool both = has_region && has_contour && edges > static_cast<int>(n) + 1;
  options.max_evaluations = job.evaluations - (both ? edges : 0);
  const SimplexResult regions = minimise(cost, start, space.block.bounds, options);
  if (both) {
    contour = true;
    options.max_evaluations = job.evaluations - static_cast<int>(children.size());
    minimise(cost, restart_simplex(regions.simplex, kRestart * space.block.steps, space.block.bounds),
             space.block.bounds, options);
  }
  return children;
}

// Local search of this program: trunk and arms in turn, with the prior, from the prediction or from the
// parent.
std::vector<Particle> search_blocks(const FilterContext& context, const Generation& generation,
                                    const Job& job, bool best, Backend& backend) {
  const Particle& parent = generation.parents[static_cast<std::size_t>(job.parent)];
  Random random = context.random(
      purpose::kSimplex, 2 * static_cast<std::uint64_t>(job.parent) + static_cast<std::uint64_t>(job.number));
  RegistrationConfig search = context.search;
  search.iterations = job.evaluations;
  if (!job.proposes) {
    search.proposals = no_proposals();
  }
  // The best mode starts once from its prediction and once from where it was, the better of the two first.
  Pose start = parent.pose;
  if (best) {
    Objective image(backend, context.frame, context.model, context.limits);
    const bool moves_on = image(context.predicted, search.region) < image(start, search.region);
    start = moves_on == (job.number == 0) ? context.predicted : start;
  }
  Objective objective(backend, context.frame, context.model, context.limits,
                      prior_at(context.model.body, start, context.heading));
  const RegistrationResult found = register_pose(objective, start, search, random);
  Particle child;
  child.pose = found.pose;
  child.score = found.score;
  child.log_likelihood = log_likelihood(context, child.pose, child.score, job.parent);
  child.parent = job.parent;
  child.prior = static_cast<double>(job.evaluations) / context.config.particles;
  child.origin = Origin::optimised;
  child.measured = true;
  return {child};
}

std::vector<Job> jobs_of(const FilterContext& context, const Generation& generation) {
  std::vector<Job> jobs;
  const std::size_t best = heaviest(generation.parents);
  const auto dimensions = static_cast<int>(numbers_of(generation.moving).size());
  for (std::size_t i = 0; i < generation.counts.size(); ++i) {
    const int count = generation.counts[i];
    if (context.config.blocks) {
      if (generation.parents.size() <= static_cast<std::size_t>(context.config.modes) ||
          count >= context.config.mode_least) {
        const int evaluations = std::clamp(count, context.config.mode_least, context.config.mode_most);
        // The best mode is searched from its prediction and from where it was: the nearest minima may differ.
        // With landmarks they rarely do.
        const bool brief = context.frame.landmarks.has_value();
        const int second = brief ? std::min(evaluations, context.config.second_evaluations) : evaluations;
        jobs.push_back(
            {static_cast<int>(i), evaluations, 0, i == best, i == best ? evaluations - second : 0});
        if (i == best && second > 1) {
          jobs.push_back({static_cast<int>(i), second, 1, !brief});
        }
      }
    } else if (dimensions > 0 && count > dimensions) {
      jobs.push_back({static_cast<int>(i), count});
    }
  }
  return jobs;
}

}  // namespace

void optimise_families(const FilterContext& context, Generation& generation) {
  const std::vector<Job> jobs = jobs_of(context, generation);
  const auto best = static_cast<int>(heaviest(generation.parents));
  for (const Job& job : jobs) {
    // The evaluations that the brief search saves are not spent on diffused children instead.
    int& left = generation.counts[static_cast<std::size_t>(job.parent)];
    left = std::max(0, left - job.saved);
    const bool blocks = context.config.blocks;
    generation.searches.push_back({.run =
                                       [=, &context, &generation](Backend& backend) {
                                         return blocks ? search_blocks(context, generation, job,
                                                                       job.parent == best, backend)
                                                       : descend(context, generation, job, backend);
                                       },
                                   .evaluations = blocks ? job.evaluations : 0,
                                   .family = job.parent});
  }
}

}  // namespace telemime
