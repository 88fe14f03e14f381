// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/modes.h"

#include <gtest/gtest.h>

#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

using testing_scene::both_arms_seen;
using testing_scene::kDegree;
using testing_scene::particle;
using testing_scene::Scene;

Pose with_left_elbow(double degrees) {
  Pose pose = both_arms_seen();
  pose[Angle::l_elbow_flexion] = degrees * kDegree;
  return pose;
}

// Two modes of 0.64 and 0.36.
Generation two_modes() {
  Generation generation;
  generation.parents = {particle(with_left_elbow(-20), 0.36, -7.0),
                        particle(with_left_elbow(-100), 0.5, -3.0),
                        particle(with_left_elbow(-103), 0.14, -2.0)};
  return generation;
}

// The parents that are left.
std::vector<Particle> merged(Scene& scene) {
  Generation generation = two_modes();
  merge_modes(scene.context(), generation);
  return generation.parents;
}

TEST(MergeModes, TheLikeliestParticleStandsForItsMode) {
  Scene scene;
  scene.config.memory = 1.0;
  const std::vector<Particle> parents = merged(scene);
  ASSERT_EQ(parents.size(), 2U);
  EXPECT_EQ(parents[0].pose.vector(), with_left_elbow(-103).vector());
  EXPECT_NEAR(parents[0].weight, 0.64, 1e-12);
  EXPECT_EQ(parents[1].pose.vector(), with_left_elbow(-20).vector());
  EXPECT_NEAR(parents[1].weight, 0.36, 1e-12);
}

TEST(MergeModes, MemoryLevelsTheWeights) {
  Scene scene;
  scene.config.memory = 0.5;  // roots: 0.8 and 0.6
  const std::vector<Particle> parents = merged(scene);
  ASSERT_EQ(parents.size(), 2U);
  EXPECT_NEAR(parents[0].weight, 0.8 / 1.4, 1e-12);
  EXPECT_NEAR(parents[1].weight, 0.6 / 1.4, 1e-12);
  scene.config.memory = 0.0;
  EXPECT_NEAR(merged(scene)[0].weight, 0.5, 1e-12);
}

TEST(MergeModes, OnlyTheHeaviestStay) {
  Scene scene;
  scene.config.modes = 1;
  const std::vector<Particle> parents = merged(scene);
  ASSERT_EQ(parents.size(), 1U);
  EXPECT_NEAR(parents[0].weight, 1.0, 1e-12);
  EXPECT_EQ(parents[0].pose.vector(), with_left_elbow(-103).vector());
}

TEST(MergeModes, TheRadiusDecidesWhatIsApart) {
  Scene scene;
  scene.config.mode_radius = 1.0;
  EXPECT_EQ(merged(scene).size(), 1U);
  scene.config.mode_radius = 0.001;
  EXPECT_EQ(merged(scene).size(), 3U);
}

}  // namespace
}  // namespace telemime
