// SPDX-License-Identifier: Apache-2.0
#include "telemime/search/proposals.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "telemime/body/arm_flips.h"
#include "telemime/body/arm_parts.h"
#include "telemime/search/arm_search.h"
#include "telemime/search/blocks.h"

namespace telemime {
namespace {

constexpr int kFlips = 3;
// Least distance (m) of a proposal's wrist from the present one: nearer proposals mostly lead to the same
// minimum and would displace the others. And least distance between the wrists of two proposals that are both
// searched.
constexpr double kAway = 0.15;
constexpr double kApart = 0.10;

// The same as search_block(); one evaluation would only repeat the start.
ScoredPose improved(Objective& objective, const ScoredPose& from, const SearchBlock& block,
                    const ObjectiveWeights& weights, int evaluations) {
  return evaluations < 2 ? from : search_block(objective, from, block, weights, evaluations);
}

Eigen::Vector3d wrist_of(const Body& body, const Pose& pose, Side side) {
  return forward_kinematics(body, pose).joints[arm_parts(side).wrist];
}

// The cheapest candidates whose wrists are kAway from that of `here` and kApart from each other.
std::vector<ScoredPose> distinct(std::vector<ScoredPose> candidates, const Body& body, const Pose& here,
                                 Side side, int count) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const ScoredPose& a, const ScoredPose& b) { return a.cost < b.cost; });
  const Eigen::Vector3d own = wrist_of(body, here, side);
  std::vector<Eigen::Vector3d> wrists;
  std::vector<ScoredPose> kept;
  for (const ScoredPose& c : candidates) {
    if (static_cast<int>(kept.size()) == count) {
      break;
    }
    const Eigen::Vector3d wrist = wrist_of(body, c.pose, side);
    if ((wrist - own).norm() >= kAway &&
        std::all_of(wrists.begin(), wrists.end(),
                    [&](const Eigen::Vector3d& w) { return (w - wrist).norm() >= kApart; })) {
      wrists.push_back(wrist);
      kept.push_back(c);
    }
  }
  return kept;
}

std::vector<Pose> proposed_arms(const Objective& objective, const Pose& from, Side side,
                                const ProposalConfig& config, Random& random) {
  const Body& body = objective.model().body;
  const JointLimits& limits = objective.limits();
  std::vector<Pose> arms = forearm_fan(body, from, side, limits, config.directions, random);
  for (int i = 0; i < config.arms; ++i) {
    arms.push_back(random_arm(body, from, side, limits, random));
  }
  if (config.flips) {
    const std::vector<Pose> flips = arm_flips(body, from, side, limits);
    arms.insert(arms.end(), flips.begin(), flips.end());
  }
  return arms;
}

}  // namespace

ProposalConfig no_proposals() {
  ProposalConfig none;
  none.directions = 0;
  none.arms = 0;
  none.flips = false;
  none.upright = false;
  return none;
}

int ProposalConfig::evaluations() const {
  return directions + arms + (flips ? kFlips : 0) + kept * turns + refine + refine / 2;
}

ProposalConfig ProposalConfig::within(int most) const {
  ProposalConfig less = *this;
  if (evaluations() <= most) {
    return less;
  }
  constexpr int kFewest = 8;  // directions; fewer rarely find a lost arm
  for (double share = static_cast<double>(most) / evaluations(); share > 0.0; share -= 0.02) {
    const auto shared = [&](int whole) { return static_cast<int>(std::floor(whole * share)); };
    less.directions = shared(directions);
    less.arms = shared(arms);
    less.kept = std::max(1, shared(kept));
    less.refine = shared(refine);
    if (less.directions + less.arms < std::min(kFewest, directions + arms)) {
      break;
    }
    if (less.evaluations() <= most) {
      return less;
    }
  }
  return no_proposals();
}

SettingTable settings_of(ProposalConfig& c) {
  const std::string group = "registration.proposals.";
  return {
      {number(group + "directions", &c.directions, {0, 10000}, "",
              "Directions of the forearm about the elbow that are proposed for each arm."),
       number(group + "arms", &c.arms, {0, 10000}, "", "Random whole arms that are proposed for each arm."),
       flag(group + "flips", c.flips, "Propose the mirror images of each arm in depth."),
       flag(group + "upright", c.upright, "Propose the trunk half as bent and turned once in a frame."),
       number(
           group + "kept", &c.kept, {1, 100}, "",
           "Best proposals that are refined; their wrists are 15 cm from the present one and 10 cm apart."),
       number(group + "turns", &c.turns, {0, 10000}, "evaluations",
              "Effort to turn the forearm of each of these."),
       number(group + "refine", &c.refine, {0, 10000}, "evaluations",
              "Effort to refine the best of these; the present arm gets half of it."),
       number(group + "margin", &c.margin, {0, 10}, "",
              "Difference of the costs above which the proposal replaces the present arm.")},
      {}};
}

Pose propose_upright(Objective& objective, const Pose& start, const ObjectiveWeights& weights,
                     double simplex_factor, int evaluations) {
  const Body& body = objective.model().body;
  const JointLimits& limits = objective.limits();
  Pose upright = start;
  for (const Angle a : {Angle::root_torsion, Angle::root_roll, Angle::root_tilt}) {
    upright[a] = 0.5 * start[a];
  }
  const auto neck = [&](const Pose& pose) { return forward_kinematics(body, pose).joints[Joint::neck]; };
  upright.root += neck(start) - neck(upright);
  for (const Side side : {Side::left, Side::right}) {
    upright = with_wrist(body, upright, side, arm_target(body, start, side), limits);
  }
  // The arms fit the trunk with which they were tracked: both candidates get a short search before the
  // comparison.
  const auto settled = [&](const Pose& pose) {
    ScoredPose best = {pose, objective(pose, weights)};
    for (const Side side : {Side::left, Side::right}) {
      best =
          improved(objective, best, part_of(bones_block(body, best.pose, side, limits, simplex_factor), 0, 4),
                   weights, evaluations / 4);
    }
    return best;
  };
  const ScoredPose rival = settled(limits.clamp(upright));
  const ScoredPose own = settled(start);
  return rival.cost < own.cost ? rival.pose : own.pose;
}

Pose propose_arms(Objective& objective, const Pose& start, const ObjectiveWeights& weights,
                  const ProposalConfig& config, bool both, double simplex_factor, Random& random) {
  const Body& body = objective.model().body;
  const JointLimits& limits = objective.limits();
  std::vector<Side> sides = {Side::left, Side::right};
  if (!both) {
    sides = {random.uniform() < 0.5 ? Side::left : Side::right};
  }
  ScoredPose best = {start, objective(start, weights)};
  const auto bones = [&](const Pose& pose, Side side) {
    return bones_block(body, pose, side, limits, simplex_factor);
  };
  for (const Side side : sides) {
    // Evaluate all proposals and keep the best that differ.
    std::vector<ScoredPose> others;
    for (const Pose& arm : proposed_arms(objective, best.pose, side, config, random)) {
      others.push_back({arm, objective(arm, weights)});
    }
    others = distinct(std::move(others), body, best.pose, side, config.kept);
    if (others.empty()) {
      continue;
    }
    // Turn their forearms, then search the best one and the present arm further.
    for (ScoredPose& other : others) {
      other = improved(objective, other, part_of(bones(other.pose, side), 2, 2), weights, config.turns);
    }
    const ScoredPose other =
        *std::min_element(others.begin(), others.end(),
                          [](const ScoredPose& a, const ScoredPose& b) { return a.cost < b.cost; });
    const ScoredPose rival = improved(objective, other, bones(other.pose, side), weights, config.refine);
    best = improved(objective, best, bones(best.pose, side), weights, config.refine / 2);
    if (rival.cost + config.margin < best.cost) {
      best = rival;
    }
  }
  return best.pose;
}

}  // namespace telemime
