// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracker/set_up.h"

#include <gtest/gtest.h>

#include "telemime/core/errors.h"
#include "telemime/core/in_parallel.h"

namespace telemime {
namespace {

Camera camera() {
  return camera_from_field_of_view(320, 240, 60.0);
}

TEST(WithBudget, WithoutABudgetNothingChanges) {
  Config config;
  config.filter.particles = 777;
  EXPECT_EQ(to_json(with_budget(config, camera())), to_json(config));
}

TEST(WithBudget, MoreTimeIsMoreEvaluationsAndAllAreValid) {
  const auto in = [](double ms) {
    Config config;
    config.image.width = 160;
    config.image.height = 120;
    config.budget_ms = ms;
    const Config fixed = with_budget(config, camera());
    fixed.validate();
    EXPECT_GE(fixed.registration.iterations, 2) << ms;
    EXPECT_GE(fixed.filter.particles, 1) << ms;
    EXPECT_GE(fixed.filter.turn_evaluations, 1) << ms;
    EXPECT_GE(fixed.filter.walk_evaluations, 1) << ms;
    EXPECT_LE(fixed.filter.mode_least, fixed.filter.mode_most) << ms;
    // What is not about effort stays.
    EXPECT_EQ(fixed.filter.memory, config.filter.memory);
    EXPECT_EQ(fixed.seed, config.seed);
    return fixed;
  };
  // What an evaluation costs is measured again each time: only very different budgets must differ.
  const Config none = in(0.0001);
  const Config little = in(1.0);
  const Config much = in(30000.0);  // enough under sanitizers, too
  EXPECT_LT(none.filter.particles, 20);
  EXPECT_GT(much.filter.particles, 10 * little.filter.particles);
  EXPECT_GT(much.registration.iterations, 10 * little.registration.iterations);
  // Parts of the search are never made larger than they are configured.
  EXPECT_EQ(much.filter.mode_most, FilterConfig().mode_most);
  EXPECT_EQ(much.filter.turn_evaluations, FilterConfig().turn_evaluations);
  EXPECT_EQ(much.filter.walk_evaluations, FilterConfig().walk_evaluations);
}

TEST(WithBudget, TheDearestFrameCostsNoMoreThanTheTotalOnEachThread) {
  for (const int threads : {1, 2}) {
    Config config;
    config.budget_ms = 1000.0;
    config.threads = threads;
    config.filter.mode_most = config.filter.turn_evaluations = config.filter.walk_evaluations =
        config.filter.landmark_evaluations = config.filter.second_evaluations = 100000;
    const Config fixed = with_budget(config, camera());
    const FilterConfig& filter = fixed.filter;
    // Two searches of the best mode, then one trunk by chance and two with a long search.
    const int dearest = 2 * filter.mode_most + filter.turn_evaluations + 2 * filter.walk_evaluations;
    const int total = fixed.registration.iterations - 1;
    ASSERT_GE(total, 100) << "where no least number counts";
    EXPECT_LE(dearest, threads * total + 5 * 5) << threads;
    // With landmarks: one search of the best mode in full, one that is brief, and two of proposals.
    const int with_landmarks = filter.mode_most + std::min(filter.mode_most, filter.second_evaluations) +
                               filter.landmark_searches * filter.landmark_evaluations;
    EXPECT_LE(with_landmarks, threads * total + 5 * 5) << threads;
  }
}

TEST(WithBudget, MoreThreadsThanProcessorsAreNone) {
  Config config;
  config.budget_ms = 1000.0;
  const Config all = with_budget(config, camera());
  config.threads = 100 * usable_threads(0);
  const Config more = with_budget(config, camera());
  // What an evaluation costs is measured again each time.
  EXPECT_LT(more.filter.particles, 10 * all.filter.particles);
}

}  // namespace
}  // namespace telemime
