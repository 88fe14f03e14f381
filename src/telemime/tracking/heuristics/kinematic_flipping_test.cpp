// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/kinematic_flipping.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "telemime/body/arm_flips.h"
#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

using testing_scene::both_arms_seen;
using testing_scene::kDegree;
using testing_scene::Scene;

Particle child(const Pose& pose, int parent, double log_likelihood) {
  Particle p;
  p.pose = pose;
  p.parent = parent;
  p.log_likelihood = log_likelihood;
  p.measured = true;
  p.origin = Origin::diffused;
  return p;
}

// Three families; the best of each: -2 of parent 5, -1 of parent 0, -4 of parent 3.
Generation families() {
  Pose other = both_arms_seen();
  other[Angle::l_elbow_flexion] -= 10 * kDegree;
  Pose third = both_arms_seen();
  third[Angle::r_elbow_flexion] -= 10 * kDegree;
  Generation generation;
  generation.particles = {child(third, 5, -6.0), child(other, 5, -2.0),
                          child(third, 0, -3.0), child(both_arms_seen(), 0, -1.0),
                          child(third, 3, -4.0), child(other, 3, -5.0)};
  return generation;
}

// The particles that were added.
std::vector<Particle> flipped(Scene& scene) {
  Generation generation = families();
  const std::size_t before = generation.particles.size();
  flip_best(scene.context(), generation);
  const Generation untouched = families();
  for (std::size_t i = 0; i < before; ++i) {
    EXPECT_EQ(generation.particles[i].pose.vector(), untouched.particles[i].pose.vector());
  }
  return {generation.particles.begin() + static_cast<std::ptrdiff_t>(before), generation.particles.end()};
}

TEST(FlipBest, AddsTheFlipsOfTheBestOfTheBestFamilies) {
  Scene scene;
  scene.config.particles = 50;
  scene.config.flip_candidates = 2;
  const std::vector<Pose> of_first = kinematic_flips(scene.model.body, both_arms_seen(), scene.limits);
  const std::vector<Pose> of_second =
      kinematic_flips(scene.model.body, families().particles[1].pose, scene.limits);
  ASSERT_FALSE(of_first.empty());
  ASSERT_FALSE(of_second.empty());
  const std::vector<Particle> came = flipped(scene);
  ASSERT_EQ(came.size(), of_first.size() + of_second.size());
  for (std::size_t i = 0; i < came.size(); ++i) {
    const bool first = i < of_first.size();
    const Pose& pose = first ? of_first[i] : of_second[i - of_first.size()];
    EXPECT_EQ(came[i].pose.vector(), pose.vector()) << i;
    EXPECT_EQ(came[i].parent, first ? 0 : 5);
    EXPECT_EQ(came[i].origin, Origin::flipped);
    EXPECT_DOUBLE_EQ(came[i].prior, 1.0 / 50);
    EXPECT_FALSE(came[i].measured);
  }
}

TEST(FlipBest, AsManyFamiliesAsAreAskedFor) {
  Scene scene;
  scene.config.flip_candidates = 0;
  EXPECT_TRUE(flipped(scene).empty());
  scene.config.flip_candidates = 1;
  for (const Particle& p : flipped(scene)) {
    EXPECT_EQ(p.parent, 0);
  }
  scene.config.flip_candidates = 1000;
  const std::vector<Particle> all = flipped(scene);
  EXPECT_EQ(std::count_if(all.begin(), all.end(), [](const Particle& p) { return p.parent == 3; }),
            static_cast<std::ptrdiff_t>(
                kinematic_flips(scene.model.body, families().particles[4].pose, scene.limits).size()));
}

}  // namespace
}  // namespace telemime
