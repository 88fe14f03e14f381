// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/two_step.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "telemime/core/errors.h"
#include "telemime/core/stopwatch.h"

namespace telemime {
namespace {

constexpr std::size_t kParts = 3;  // trunk, left arm, right arm

// Result of one step: the pose, and the last simplex of each block.
struct StepResult {
  Pose pose;
  std::vector<std::vector<Vertex>> simplexes;
  bool converged = true;
};

// Arms are searched by their bones in even rounds and by their wrist in odd rounds: the first moves the
// forearm without the elbow, the second slides the wrist along its viewing ray.
SearchBlock make_block(std::size_t part, int round, const Objective& objective, const Pose& pose,
                       double factor) {
  const Body& body = objective.model().body;
  const JointLimits& limits = objective.limits();
  if (part == 0) {
    return trunk_block(body, pose, limits, factor);
  }
  const Side side = part == 1 ? Side::left : Side::right;
  return round % 2 == 0 ? bones_block(body, pose, side, limits, factor)
                        : arm_block(body, pose, side, limits, factor);
}

// Extent of the first simplex along each axis.
Eigen::VectorXd first_steps(const SearchBlock& block, const std::vector<Vertex>* last, double shrink) {
  if (last == nullptr || last->size() < 2) {
    return block.steps;
  }
  // The extent of the last simplex, centred on the block's present start: other blocks may have moved since.
  // That of an arm has the numbers of the last round, also where the first round of the edge step has others:
  // kept within the steps it does as well as one of the same numbers (five seeds of the four gestures).
  Eigen::VectorXd extent = block.steps * shrink;
  for (const Vertex& v : *last) {
    extent = extent.cwiseMax((v.point - last->front().point).cwiseAbs().cwiseMin(block.steps));
  }
  return extent;
}

Eigen::VectorXd either_way(Eigen::VectorXd steps, Random& random) {
  for (double& step : steps) {
    step = random.uniform() < 0.5 ? -step : step;
  }
  return steps;
}

StepResult run_step(Objective& objective, const Pose& start, const RegistrationConfig& config,
                    const ObjectiveWeights& weights, int budget, const StepResult* before, Random& random) {
  StepResult result;
  result.pose = start;
  result.simplexes.resize(kParts);
  const double shrink = config.edge_factor / config.simplex_factor;
  const auto search = [&](const SearchBlock& block, std::size_t part, int evaluations) {
    if (evaluations < 2) {
      return;
    }
    const auto* last = before != nullptr ? &before->simplexes[part] : nullptr;
    Eigen::VectorXd steps = first_steps(block, last, shrink);
    if (config.blocks && part == 0) {
      // Regions and contours hardly show where the trunk is turned: it would drift towards the side on which
      // the simplex always begins. Arms are visible; random steps would only make them less steady.
      steps = either_way(steps, random);
    }
    SimplexOptions options;
    options.tolerance = config.tolerance;
    options.max_evaluations = evaluations;
    const SimplexResult found =
        minimise([&](const Eigen::VectorXd& x) { return objective(block.decode(x), weights); },
                 axis_simplex(block.start, steps, block.bounds), block.bounds, options);
    result.pose = block.decode(found.best().point);
    result.simplexes[part] = found.simplex;
    result.converged = result.converged && found.reason == StopReason::converged;
  };
  // Reference: one simplex over all numbers.
  if (!config.blocks) {
    search(whole_block(start, objective.limits(), config.simplex_factor), 0, budget);
    return result;
  }
  // Trunk and arms in turn; each round starts with half the step of the round before.
  const int first = objective.evaluations();
  constexpr std::array<double, kParts> kShare = {0.2, 0.4, 0.4};
  for (int round = 0; round < config.rounds; ++round) {
    const double factor = config.simplex_factor * std::pow(0.5, round);
    for (std::size_t part = 0; part < kParts; ++part) {
      const int left = budget - (objective.evaluations() - first);
      const int planned = static_cast<int>(std::lround(budget * kShare[part] / config.rounds));
      search(make_block(part, round, objective, result.pose, factor), part, std::min(left, planned));
    }
  }
  return result;
}

bool is_bent(const Pose& pose) {
  constexpr double kUpright = 0.07;  // rad
  return std::max({std::abs(pose[Angle::root_torsion]), std::abs(pose[Angle::root_roll]),
                   std::abs(pose[Angle::root_tilt])}) > kUpright;
}

// Proposals for both arms if there are enough evaluations for one arm in full, else for one arm at random.
Pose propose(Objective& objective, const Pose& start, const RegistrationConfig& config, int budget,
             Random& random) {
  constexpr int kBeside = 3;  // evaluations of the start and of the upright trunk before any search
  const int most = std::min(static_cast<int>(std::floor(config.proposal_share * budget)), budget - kBeside);
  const bool upright = config.proposals.upright && most >= kBeside;
  const int settle = upright && is_bent(start) ? most / 8 : 0;
  const bool both = most - settle >= config.proposals.evaluations();
  const ProposalConfig proposals = config.proposals.within(both ? (most - settle) / 2 : most - settle);
  const Pose from =
      upright ? propose_upright(objective, start, config.region, config.simplex_factor, settle) : start;
  return proposals.any_arms()
             ? propose_arms(objective, from, config.region, proposals, both, config.simplex_factor, random)
             : from;
}

}  // namespace

SettingTable settings_of(RegistrationConfig& c) {
  SettingTable table;
  table.rows = {
      number("registration.iterations", &c.iterations, {1, 1000000}, "evaluations",
             "Effort of a frame with the methods two-step, regions and edges."),
      number("registration.region_share", &c.region_share, {0, 1}, "",
             "Share of the effort for the region step; the rest is for the edge step."),
      number("registration.simplex_factor", &c.simplex_factor, {0.001, 20}, "",
             "Size of the first simplex over the typical motion between two frames."),
      number("registration.edge_factor", &c.edge_factor, {0.001, 20}, "",
             "Smallest size of the first simplex of the edge step, in the same unit."),
      flag("registration.blocks", c.blocks,
           "Search trunk, left arm and right arm in turn; false: one simplex over all 23 numbers."),
      number("registration.rounds", &c.rounds, {1, 10}, "", "Rounds over trunk and arms in each step."),
      number("registration.tolerance", &c.tolerance, {0, 0.999}, "",
             "Relative difference of the costs in a simplex at which it has converged."),
      number("registration.proposal_share", &c.proposal_share, {0, 1}, "",
             "Largest share of the region step for proposals; where it is too small for both arms, one at "
             "random has its turn."),
  };
  table.append(settings_of(c.proposals));
  table.append(settings_of(c.region, "registration.region_step"));
  table.append(settings_of(c.edge, "registration.edge_step"));
  return table;
}

// A simplex over more than this many times the usual motion is no longer a local search.
constexpr double kMostSimplexFactor = 20.0;

RegistrationConfig for_time_step(RegistrationConfig config, double frames) {
  config.simplex_factor = std::min(kMostSimplexFactor, config.simplex_factor * std::sqrt(frames));
  for (ObjectiveWeights* w : {&config.region, &config.edge}) {
    w->temporal /= frames;
    w->trunk /= frames;
  }
  return config;
}

RegistrationConfig with_cues(RegistrationConfig config, const CueTable& cues) {
  for (std::size_t i = kCues.size(); i < cues.size(); ++i) {
    config.region.cues[i] = cues[i].region_step;
    config.edge.cues[i] = cues[i].edge_step;
  }
  return config;
}

RegistrationConfig reference_registration() {
  RegistrationConfig config;
  const auto only = [](std::size_t index) {
    CueValues weights{};
    weights[index] = 1.0;
    return weights;
  };
  config.blocks = false;
  config.region_share = 0.5;
  config.proposals = no_proposals();
  config.region = {.cues = only(cue::kRegion)};
  config.edge = {.cues = only(cue::kContour)};
  return config;
}

RegistrationResult register_pose(Objective& objective, const Pose& start, const RegistrationConfig& config,
                                 Random& random) {
  const double share = config.method == Method::regions ? 1.0
                       : config.method == Method::edges ? 0.0
                                                        : config.region_share;
  // Divide the evaluations; the last one scores the pose that is returned.
  const int budget = std::max(1, config.iterations - 1);
  const int region_budget = static_cast<int>(std::lround(share * budget));

  RegistrationResult result;
  StepResult step;
  step.pose = start;
  step.simplexes.resize(kParts);
  // Region step: minimise F (thesis equation 2.5) from the best proposal.
  int before = objective.evaluations();
  Stopwatch stopwatch;
  if (region_budget > 0) {
    const Pose from = propose(objective, start, config, region_budget, random);
    const int spent = objective.evaluations() - before;
    step = run_step(objective, from, config, config.region, region_budget - spent, nullptr, random);
  }
  result.region_evaluations = objective.evaluations() - before;
  result.region_ms = stopwatch.lap();

  // Edge step: minimise D_C (thesis equation 3.13) from the extent of the last simplex (thesis 3.5.4).
  before = objective.evaluations();
  if (budget - region_budget > 0) {
    step = run_step(objective, step.pose, config, config.edge, budget - region_budget,
                    region_budget > 0 ? &step : nullptr, random);
  }
  result.edge_evaluations = objective.evaluations() - before;
  result.edge_ms = stopwatch.lap();
  result.pose = objective.limits().clamp(step.pose);
  result.score = objective.score(result.pose, objective.cues().needs());
  result.converged = step.converged;
  return result;
}

Method parse_method(const std::string& name) {
  for (const auto& [known, method] : kMethodNames) {
    if (name == known) {
      return method;
    }
  }
  throw Error(ErrorKind::usage, "unknown method '" + name + "'", "Use regions, edges or two-step.");
}

}  // namespace telemime
