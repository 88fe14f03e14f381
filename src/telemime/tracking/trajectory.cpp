// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/trajectory.h"

#include <algorithm>
#include <limits>

#include "telemime/body/arm_flips.h"
#include "telemime/search/arm_exchange.h"
#include "telemime/search/two_step.h"

namespace telemime {
namespace {

// Weights of the image and of what is known without it, but not of neighbouring frames.
ObjectiveWeights still_weights(const TrajectoryContext& context) {
  ObjectiveWeights weights = context.search.edge;
  weights.temporal = 0.0;
  weights.trunk = 0.0;
  return weights;
}

std::vector<ScoredPose> scored(const TrajectoryContext& context, const TrajectoryFrame& frame,
                               const std::vector<Pose>& poses, Backend& backend) {
  Objective objective(backend, frame.frame, context.model, context.limits, Prior{.heading = frame.heading});
  const ObjectiveWeights weights = still_weights(context);
  std::vector<ScoredPose> result;
  result.reserve(poses.size());
  for (const Pose& pose : poses) {
    result.push_back({pose, objective(pose, weights)});
  }
  std::stable_sort(result.begin(), result.end(),
                   [](const ScoredPose& a, const ScoredPose& b) { return a.cost < b.cost; });
  return result;
}

std::vector<Pose> poses_of(const std::vector<ScoredPose>& scored) {
  std::vector<Pose> poses;
  poses.reserve(scored.size());
  for (const ScoredPose& s : scored) {
    poses.push_back(s.pose);
  }
  return poses;
}

}  // namespace

SettingTable settings_of(TrajectoryConfig& c) {
  return {
      {number("trajectory.stretch", &c.stretch, {1, 10000}, "1/25 s",
              "Time that is decided together (offline)."),
       number("trajectory.overlap", &c.overlap, {0, 1000}, "1/25 s",
              "Time after it that is taken into account."),
       number("trajectory.arms", &c.arms, {1, 100}, "",
              "Arms of each side that are combined with each other in each frame."),
       number("trajectory.kept", &c.kept, {1, 1000}, "",
              "Poses of a frame among which the trajectory chooses."),
       number("trajectory.motion", &c.motion, {0, 1e6}, "",
              "Cost of the squared motion (over 0.15 m) of elbows and wrists in 1/25 s."),
       number("trajectory.sweeps", &c.sweeps, {0, 100}, "", "Searches of each pose between its neighbours."),
       number("trajectory.evaluations", &c.evaluations, {1, 1000000}, "evaluations",
              "Effort of each of these searches."),
       number("trajectory.between", &c.between, {0, 1e6}, "",
              "Weight of the squared distance (over 0.15 m) of elbows and wrists from the line between their "
              "neighbours, 1/25 s away, in that search.")},
      {}};
}

std::vector<ScoredPose> combine(const TrajectoryContext& context, const TrajectoryFrame& frame,
                                Backend& backend) {
  const Body& body = context.model.body;
  const auto arms = static_cast<std::size_t>(context.config.arms);
  // Candidates of the searches and the flips of the estimate's arms.
  std::vector<Pose> all = frame.candidates;
  for (const Side side : {Side::left, Side::right}) {
    for (const Pose& flipped : arm_flips(body, frame.candidates.front(), side, context.limits)) {
      all.push_back(flipped);
    }
  }
  const std::vector<Pose> ranked = poses_of(scored(context, frame, all, backend));
  // Every distinct left arm with every distinct right arm on up to three trunks, which often are the same.
  std::vector<Pose> trunks = {ranked.front()};
  const auto add_trunk = [&trunks](const Pose& pose) {
    const PoseVector numbers = pose.vector();
    const bool known = std::any_of(trunks.begin(), trunks.end(), [&numbers](const Pose& trunk) {
      return trunk.vector().head<9>() == numbers.head<9>();
    });
    if (!known) {
      trunks.push_back(pose);
    }
  };
  add_trunk(frame.candidates.front());
  if (frame.forward < frame.candidates.size()) {
    add_trunk(frame.candidates[frame.forward]);
  }
  const std::vector<Pose> left = distinct_arms(body, ranked, Side::left, arms);
  const std::vector<Pose> right = distinct_arms(body, ranked, Side::right, arms);
  for (const Pose& trunk : trunks) {
    for (const Pose& l : left) {
      for (const Pose& r : right) {
        all.push_back(with_arms_of(body, trunk, l, r, context.limits));
      }
    }
  }
  std::vector<ScoredPose> best = scored(context, frame, all, backend);
  // They are in the order of their costs, so that equal ones are neighbours.
  best.erase(std::unique(
                 best.begin(), best.end(),
                 [](const ScoredPose& a, const ScoredPose& b) { return a.pose.vector() == b.pose.vector(); }),
             best.end());
  best.resize(std::min(best.size(), static_cast<std::size_t>(context.config.kept)));
  return best;
}

std::vector<std::size_t> cheapest_path(const Body& body, std::span<const std::vector<ScoredPose>> frames,
                                       std::span<const double> motion, const Pose* before) {
  // Forward pass: the least cost of reaching each pose, and from where.
  std::vector<std::vector<std::size_t>> from(frames.size());
  std::vector<double> costs_before;
  std::vector<JointPositions> joints_before;
  if (before != nullptr) {
    costs_before = {0.0};
    joints_before = {forward_kinematics(body, *before).joints};
  }
  for (std::size_t t = 0; t < frames.size(); ++t) {
    std::vector<double> costs;
    std::vector<JointPositions> joints;
    for (const ScoredPose& here : frames[t]) {
      const Kinematics k = forward_kinematics(body, here.pose);
      double least = costs_before.empty() ? 0.0 : std::numeric_limits<double>::infinity();
      std::size_t best = 0;
      for (std::size_t i = 0; i < costs_before.size(); ++i) {
        const double cost = costs_before[i] + motion[t] * distance_from_predicted(k, joints_before[i]);
        if (cost < least) {
          least = cost;
          best = i;
        }
      }
      costs.push_back(least + here.cost);
      joints.push_back(k.joints);
      from[t].push_back(best);
    }
    costs_before = std::move(costs);
    joints_before = std::move(joints);
  }
  // Backward pass: the poses along the cheapest path.
  std::vector<std::size_t> path(frames.size());
  auto at = static_cast<std::size_t>(std::min_element(costs_before.begin(), costs_before.end()) -
                                     costs_before.begin());
  for (std::size_t t = frames.size(); t-- > 0;) {
    path[t] = at;
    at = from[t][at];
  }
  return path;
}

std::vector<Pose> best_trajectory(const TrajectoryContext& context, std::span<const TrajectoryFrame> frames,
                                  const Pose* before, Random& random) {
  const Body& body = context.model.body;
  const TrajectoryConfig& config = context.config;
  // Choose among the candidates of all frames.
  std::vector<std::vector<ScoredPose>> choices(frames.size());
  context.evaluators.each(frames.size(), [&](std::size_t t, Backend& backend) {
    choices[t] = combine(context, frames[t], backend);
  });
  std::vector<Pose> poses;
  poses.reserve(frames.size());
  if (frames.empty()) {
    return poses;
  }
  std::vector<double> motion;
  motion.reserve(frames.size());
  for (const TrajectoryFrame& frame : frames) {
    motion.push_back(config.motion / frame.time_step);
  }
  const std::vector<std::size_t> path = cheapest_path(body, choices, motion, before);
  for (std::size_t t = 0; t < frames.size(); ++t) {
    poses.push_back(choices[t][path[t]].pose);
  }
  // Search each pose again between its neighbours, first the even frames, then the odd ones: the neighbours
  // do not move meanwhile, so the result does not depend on the threads.
  RegistrationConfig search = context.search;
  search.iterations = config.evaluations;
  search.proposals = no_proposals();
  const std::uint64_t seed = random.bits();
  for (int half = 0; half < 2 * config.sweeps; ++half) {
    const auto first = static_cast<std::size_t>(half % 2);
    const std::size_t count = (frames.size() + 1 - first) / 2;
    context.evaluators.each(count, [&](std::size_t i, Backend& backend) {
      const std::size_t t = first + 2 * i;
      const Pose& earlier = t > 0 ? poses[t - 1] : before != nullptr ? *before : poses[t];
      const Pose& later = poses[t + 1 < poses.size() ? t + 1 : t];
      const double since = frames[t].time_step;
      const double until = t + 1 < frames.size() ? frames[t + 1].time_step : since;
      Objective objective(backend, frames[t].frame, context.model, context.limits,
                          prior_between(body, earlier, later, since / (since + until), frames[t].heading));
      RegistrationConfig between = search;
      for (ObjectiveWeights* weights : {&between.region, &between.edge}) {
        weights->temporal = config.between / (0.5 * (since + until));
        weights->trunk /= 0.5 * (since + until);
      }
      Random own(seed, static_cast<std::size_t>(half) * frames.size() + t);
      poses[t] = register_pose(objective, poses[t], between, own).pose;
    });
  }
  return poses;
}

}  // namespace telemime
