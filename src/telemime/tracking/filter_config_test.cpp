// SPDX-License-Identifier: Apache-2.0
#include "telemime/tracking/filter_config.h"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "telemime/core/testing_errors.h"

namespace telemime {
namespace {

template <class T>
void expect_refused(T FilterConfig::*setting, const std::string& name, const std::vector<T>& values) {
  for (const T& value : values) {
    testing_errors::expect_refused<FilterConfig>({{name, [&](FilterConfig& c) { c.*setting = value; }}});
  }
}

template <class T>
void expect_taken(T FilterConfig::*setting, const std::vector<T>& values) {
  for (const T& value : values) {
    FilterConfig config;
    config.*setting = value;
    EXPECT_NO_THROW(check_settings(config)) << value;
  }
}

TEST(FilterConfig, TheDefaultsAndTheThesissAreTaken) {
  EXPECT_NO_THROW(check_settings(FilterConfig{}));
  EXPECT_NO_THROW(check_settings(reference_filter("")));
  EXPECT_NO_THROW(check_settings(reference_filter("wd, hpm, ee, lo, kf")));
}

TEST(FilterConfig, TheThesissFilterKnowsNothingButTheImage) {
  const FilterConfig config = reference_filter("wd");
  EXPECT_EQ(config.heuristics, "wd");
  EXPECT_EQ(config.natural, 0.0);
  EXPECT_EQ(config.temporal, 0.0);
  EXPECT_EQ(config.memory, 1.0);
  EXPECT_EQ(config.trust, 1.0);
  EXPECT_EQ(config.diffusion, 1.0);
  EXPECT_EQ(config.estimate, "heaviest");
  EXPECT_FALSE(config.blocks);
}

TEST(FilterConfig, WholeNumbersOutOfRangeAreRefusedByName) {
  expect_refused(&FilterConfig::particles, "particles", {0, -1, 1000001});
  expect_refused(&FilterConfig::modes, "modes", {0, -3, 1001});
  expect_refused(&FilterConfig::mode_least, "mode_least", {9, 0, -1, 1201});
  expect_refused(&FilterConfig::mode_most, "mode_most", {99, -1, 1000001});
  expect_refused(&FilterConfig::turn_evaluations, "turn_evaluations", {9, -1, 1000001});
  expect_refused(&FilterConfig::walk_evaluations, "walk_evaluations", {9, -1, 1000001});
  expect_refused(&FilterConfig::second_evaluations, "second_evaluations", {-1, 1000001});
  expect_refused(&FilterConfig::flip_candidates, "flip_candidates", {-1, 1001});
  expect_taken(&FilterConfig::particles, {1, 1000000});
  expect_taken(&FilterConfig::modes, {1, 1000});
  expect_taken(&FilterConfig::mode_least, {10, 1200});
  expect_taken(&FilterConfig::mode_most, {100, 1000000});
  expect_taken(&FilterConfig::turn_evaluations, {10, 1000000});
  expect_taken(&FilterConfig::walk_evaluations, {10, 1000000});
  expect_taken(&FilterConfig::second_evaluations, {0, 1000000});
  expect_taken(&FilterConfig::flip_candidates, {0, 1000});
}

TEST(FilterConfig, NumbersOutOfRangeAreRefusedByName) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  expect_refused(&FilterConfig::diffusion, "diffusion", {0.0, -1.0, 100.1, nan, infinity});
  expect_refused(&FilterConfig::memory, "memory", {-0.1, 1.1, nan});
  expect_refused(&FilterConfig::trust, "trust", {0.0, -1.0, 10.1, nan});
  expect_refused(&FilterConfig::natural, "natural", {-0.1, nan});
  expect_refused(&FilterConfig::temporal, "temporal", {-0.1, nan});
  expect_refused(&FilterConfig::invalid, "invalid", {-0.1, nan});
  expect_refused(&FilterConfig::mode_radius, "mode_radius", {0.0, -0.1, 1.1, nan});
  expect_taken(&FilterConfig::diffusion, {0.01, 100.0});
  expect_taken(&FilterConfig::memory, {0.0, 1.0});
  expect_taken(&FilterConfig::trust, {0.001, 10.0});
  expect_taken(&FilterConfig::mode_radius, {0.001, 1.0});
}

TEST(FilterConfig, UnknownWordsAreNamed) {
  expect_refused(&FilterConfig::estimate, "estimate", {std::string(), std::string("median")});
  expect_taken(&FilterConfig::estimate, {std::string("mean")});
  expect_refused(&FilterConfig::heuristics, "'annealing'", {std::string("wd,annealing")});
  // The choices.
  expect_refused(&FilterConfig::heuristics, "modes, wd, hpm, ee, lo, landmarks, turn, kf, arms",
                 {std::string("wd,annealing")});
}

}  // namespace
}  // namespace telemime
