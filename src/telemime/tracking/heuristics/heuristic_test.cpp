// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/heuristics/heuristic.h"

#include <gtest/gtest.h>

#include "telemime/tracking/testing_scene.h"

namespace telemime {
namespace {

using testing_scene::both_arms_seen;
using testing_scene::particle;
using testing_scene::Scene;

// A search that finds particles with these weights.
Search finds(const std::vector<double>& weights, int evaluations = 0, int family = -1) {
  return {.run =
              [weights](Backend&) {
                std::vector<Particle> found;
                for (const double weight : weights) {
                  found.push_back(particle(both_arms_seen(), weight));
                }
                return found;
              },
          .evaluations = evaluations,
          .family = family};
}

TEST(Searches, AddWhatTheyFindInTheirOrder) {
  for (const int threads : {1, 4}) {
    Scene scene;
    scene.evaluators = Evaluators("scalar", threads);
    Generation generation;
    generation.particles = {particle(both_arms_seen(), 0.0)};
    generation.searches = {finds({0.1, 0.2}), finds({}), finds({0.3}, 40), finds({0.4})};
    run_searches(scene.context(), generation);
    std::vector<double> weights;
    for (const Particle& p : generation.particles) {
      weights.push_back(p.weight);
    }
    EXPECT_EQ(weights, (std::vector<double>{0.0, 0.1, 0.2, 0.3, 0.4}));
    EXPECT_EQ(generation.evaluations, 2 + 0 + 40 + 1);
    EXPECT_TRUE(generation.searches.empty());
  }
}

TEST(Searches, BeginWithTheLongest) {
  Scene scene;
  scene.evaluators = Evaluators("scalar", 1);
  Generation generation;
  std::vector<int> begun;
  for (const int evaluations : {1, 40, 7, 40, 300}) {
    Search search = finds({0.1}, evaluations);
    search.run = [&begun, evaluations, inner = search.run](Backend& backend) {
      begun.push_back(evaluations);
      return inner(backend);
    };
    generation.searches.push_back(search);
  }
  run_searches(scene.context(), generation);
  EXPECT_EQ(begun, (std::vector<int>{300, 40, 40, 7, 1}));
}

TEST(Searches, UseUpTheChildrenOfTheirFamily) {
  Scene scene;
  Generation generation;
  generation.counts = {10, 10, 10};
  generation.searches = {finds({0.1}, 8, 1), finds({0.1}, 8, 1), finds({0.1, 0.2, 0.3}, 0, 2),
                         finds({0.1}, 5)};
  run_searches(scene.context(), generation);
  EXPECT_EQ(generation.counts, (std::vector<int>{10, 0, 7}));
}

}  // namespace
}  // namespace telemime
