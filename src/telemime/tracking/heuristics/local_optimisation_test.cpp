// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/local_optimisation.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "telemime/likelihood/testing_landmarks.h"
#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

using testing_scene::both_arms_seen;
using testing_scene::particle;
using testing_scene::Scene;
using Searches = std::vector<std::pair<int, int>>;  // parent and evaluations of each

// A light mode with 150 children, then a heavy one with 400.
Generation two_modes() {
  Pose other = both_arms_seen();
  other[Angle::l_elbow_flexion] -= 0.5;
  Generation generation;
  generation.parents = {particle(other, 0.3), particle(both_arms_seen(), 0.7)};
  generation.counts = {150, 400};
  return generation;
}

Searches searches(Scene& scene, bool landmarks) {
  if (landmarks) {
    scene.frame.landmarks =
        testing_landmarks::perfect_landmarks(scene.model.body, both_arms_seen(), scene.camera);
  }
  Generation generation = two_modes();
  const FilterContext context = scene.context();
  optimise_families(context, generation);
  Searches asked;
  for (const Search& search : generation.searches) {
    asked.emplace_back(search.family, search.evaluations);
  }
  return asked;
}

TEST(LocalOptimisation, TheBestModeIsSearchedFromTwoStarts) {
  Scene scene;
  EXPECT_EQ(searches(scene, false), (Searches{{0, 150}, {1, 400}, {1, 400}}));
}

TEST(LocalOptimisation, WithLandmarksTheSecondSearchIsBrief) {
  Scene scene;
  scene.config.second_evaluations = 120;
  EXPECT_EQ(searches(scene, true), (Searches{{0, 150}, {1, 400}, {1, 120}}));
}

TEST(LocalOptimisation, TheSecondIsNeverLongerThanTheFirst) {
  Scene scene;
  scene.config.second_evaluations = 5000;
  EXPECT_EQ(searches(scene, true), (Searches{{0, 150}, {1, 400}, {1, 400}}));
}

TEST(LocalOptimisation, TheSecondSearchCanBeLeftOut) {
  for (const int evaluations : {0, 1}) {  // a share of 0 is rounded up to 1
    Scene scene;
    scene.config.second_evaluations = evaluations;
    EXPECT_EQ(searches(scene, true), (Searches{{0, 150}, {1, 400}})) << evaluations;
  }
}

// Distances (m) of the left wrist from the truth after the full search and after the brief one, where the
// last pose or the prediction is the truth and the other is wrong.
std::vector<double> distances(bool moved_on) {
  Scene scene;
  Pose wrong = both_arms_seen();
  wrong[Angle::l_shoulder_abduct] += 0.3;
  (moved_on ? scene.estimate : scene.predicted) = wrong;
  scene.config.mode_least = 10;
  scene.config.second_evaluations = 10;
  scene.frame.landmarks =
      testing_landmarks::perfect_landmarks(scene.model.body, both_arms_seen(), scene.camera);
  Generation generation;
  generation.parents = {particle(scene.estimate, 1.0)};
  generation.counts = {400};
  const FilterContext context = scene.context();
  optimise_families(context, generation);
  run_searches(context, generation);
  std::vector<double> away;
  for (const Particle& p : generation.particles) {
    const JointPositions truth = scene.joints(both_arms_seen());
    away.push_back((scene.joints(p.pose)[Joint::l_wrist] - truth[Joint::l_wrist]).norm());
  }
  EXPECT_DOUBLE_EQ(generation.particles.at(0).prior, 400.0 / scene.config.particles);
  EXPECT_DOUBLE_EQ(generation.particles.at(1).prior, 10.0 / scene.config.particles);
  return away;
}

TEST(LocalOptimisation, TheFullSearchHasTheBetterStart) {
  for (const bool moved_on : {false, true}) {
    const std::vector<double> away = distances(moved_on);
    EXPECT_LT(away.at(0), 0.02) << moved_on;
    EXPECT_GT(away.at(1), 0.05) << moved_on << ": 10 evaluations do not lead back";
  }
}

TEST(LocalOptimisation, OnlyTheFirstSearchProposesOtherArms) {
  // Proposals that use up all evaluations and are never taken: a search with proposals stays at its start.
  Scene scene;
  scene.search.region_share = scene.search.proposal_share = 1.0;
  scene.search.proposals = {.directions = 0,
                            .arms = 1000,
                            .flips = false,
                            .upright = false,
                            .kept = 1,
                            .turns = 0,
                            .refine = 0,
                            .margin = 10.0};
  Pose wrong = both_arms_seen();
  wrong[Angle::l_shoulder_abduct] += 0.3;
  scene.estimate = scene.predicted = wrong;
  scene.frame.landmarks =
      testing_landmarks::perfect_landmarks(scene.model.body, both_arms_seen(), scene.camera);
  Generation generation;
  generation.parents = {particle(wrong, 1.0)};
  generation.counts = {300};
  const FilterContext context = scene.context();
  optimise_families(context, generation);
  run_searches(context, generation);
  const Eigen::Vector3d truth = scene.joints(both_arms_seen())[Joint::l_wrist];
  const auto away = [&](std::size_t i) {
    return (scene.joints(generation.particles.at(i).pose)[Joint::l_wrist] - truth).norm();
  };
  EXPECT_GT(away(0), 0.07);
  EXPECT_LT(away(1), 0.03);
}

TEST(LocalOptimisation, WhatIsSavedIsNotDiffused) {
  Scene scene;
  scene.config.mode_most = 100;
  scene.config.second_evaluations = 20;
  scene.frame.landmarks =
      testing_landmarks::perfect_landmarks(scene.model.body, both_arms_seen(), scene.camera);
  Generation generation;
  generation.parents = {particle(both_arms_seen(), 1.0)};
  generation.counts = {200};
  const FilterContext context = scene.context();
  optimise_families(context, generation);
  run_searches(context, generation);
  EXPECT_EQ(generation.counts[0], 0);
}

}  // namespace
}  // namespace telemime
