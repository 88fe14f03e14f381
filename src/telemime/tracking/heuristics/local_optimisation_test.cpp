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

// A heavy mode with 400 children and a light one with 150.
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

TEST(LocalOptimisation, TheSecondSearchIsNeverLonger) {
  Scene scene;
  scene.config.second_evaluations = 5000;
  EXPECT_EQ(searches(scene, true), (Searches{{0, 150}, {1, 400}, {1, 400}}));
}

TEST(LocalOptimisation, TheSecondSearchCanBeLeftOut) {
  Scene scene;
  scene.config.second_evaluations = 0;
  EXPECT_EQ(searches(scene, true), (Searches{{0, 150}, {1, 400}}));
}

TEST(LocalOptimisation, TheFullSearchHasTheBetterStart) {
  // The arm is where it was, not where its motion led.
  Scene scene;
  scene.predicted[Angle::l_shoulder_abduct] += 0.3;
  scene.config.second_evaluations = 100;
  scene.frame.landmarks =
      testing_landmarks::perfect_landmarks(scene.model.body, both_arms_seen(), scene.camera);
  Generation generation;
  generation.parents = {particle(both_arms_seen(), 1.0)};
  generation.counts = {300};
  const FilterContext context = scene.context();
  optimise_families(context, generation);
  run_searches(context, generation);
  ASSERT_EQ(generation.particles.size(), 2U);
  EXPECT_DOUBLE_EQ(generation.particles[0].prior, 300.0 / scene.config.particles);
  EXPECT_DOUBLE_EQ(generation.particles[1].prior, 100.0 / scene.config.particles);
  const Eigen::Vector3d truth = scene.joints(both_arms_seen())[Joint::l_wrist];
  EXPECT_LT((scene.joints(generation.particles[0].pose)[Joint::l_wrist] - truth).norm(), 0.02);
}

}  // namespace
}  // namespace telemime
